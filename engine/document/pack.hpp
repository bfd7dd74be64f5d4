// SPDX-License-Identifier: Apache-2.0
// Packing: a project with everything it needs, in a folder or a zip file that can be taken to another machine. The
// files of a scene keep their places relative to each other, so that they find each other without being changed.
#pragma once

#include "document/document.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace restage::document {

struct Packed {
    std::filesystem::path project; // in the folder; of a zip file: the file itself
    std::size_t files = 0; // beside the project
    std::uint64_t bytes = 0; // of them
    std::vector<std::string> problems; // what is missing, or will not be found elsewhere; a sentence each
};

// `project`: the text of a project with absolute paths (Session::recovery_text). `out`: a folder that does not exist or
// is empty, or a file *.zip. Reads the files that the project refers to with their importers, to learn which other
// files these read, and in the end the packed project, to see that it is complete. On failure nothing is left. [worker]
Result<Packed> pack_project(const std::string& project, const std::filesystem::path& out, const plugin::Registry&,
                            const ReadOptions& = {});

bool is_packed(const std::filesystem::path&); // *.zip, in any case
// Unpacks room.zip into the folder `room` beside it, unless that exists, and returns the project in it. [worker]
Result<std::filesystem::path> unpack_project(const std::filesystem::path& archive, const io::Progress& = {});

} // namespace restage::document

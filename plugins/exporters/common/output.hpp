// SPDX-License-Identifier: Apache-2.0
// The files of one export: each is written under a temporary name in the same folder; all are renamed at the end, the
// scene file last. On failure the old export is unchanged.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace restage::exporters {

struct ExportError : std::runtime_error { // file and sentence, for error() of the reader
    ExportError(std::string f, const std::string& message) : std::runtime_error(message), file(std::move(f)) {}
    std::string file;
};

class Output {
  public:
    explicit Output(const std::filesystem::path& scene_file);
    ~Output(); // removes what was not committed
    Output(const Output&) = delete;
    Output& operator=(const Output&) = delete;

    bool has(const std::string& relative) const; // exists, or will exist, next to the scene
    const std::filesystem::path& folder() const { return folder_; }
    // "models/chair.ply": a name unique in this export, relative to the folder.
    std::string unique_file(const std::string& folder, const std::string& stem, const std::string& extension);
    void write(const std::string& relative, std::string_view bytes);
    void copy(const std::filesystem::path& from, const std::string& relative);
    // Path of `file` as the scene file would name it if it is inside the folder, else "".
    std::string inside(const std::filesystem::path& file) const;
    void commit(); // the scene file must have been written

  private:
    std::filesystem::path stage(const std::string& relative);
    struct Staged {
        std::filesystem::path temporary, target;
    };
    std::filesystem::path scene_file_, folder_;
    std::vector<Staged> staged_;
    std::vector<std::filesystem::path> made_folders_;
    std::set<std::string> taken_; // in lower case: file systems may ignore case
};

} // namespace restage::exporters

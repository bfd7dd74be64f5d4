// SPDX-License-Identifier: Apache-2.0
// Bytes of files, and files named by files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace restage::importing {

// Everything an importer reads is a regular file, of at most 16 GiB: never a folder, a device or a pipe, which may be
// endless or block for ever. nullopt: `reason` says why.
#if !defined(_WIN32)
int open_regular_file(const std::filesystem::path&, std::uint64_t& size, std::string& reason); // a descriptor, or -1
#endif
std::optional<std::string> read_file(const std::filesystem::path&, std::string& reason);

// The file that `name`, written in a file in `folder`, means; also where the name has backslashes, another case, or a
// folder from another machine in front (then the file beside is taken). Absolute; it may not exist.
std::filesystem::path find_file(const std::filesystem::path& folder, const std::string& name);

std::string lower(std::string_view); // ASCII
// "scene.obj" and "obj" (lower case)
bool has_extension(const char* path, std::string_view extension);

} // namespace restage::importing

// SPDX-License-Identifier: Apache-2.0
// Bytes of files, and files named in files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace restage::importing {

// Everything an importer reads is a regular file, of at most 16 GiB: never a folder, a device or a pipe, which may be
// endless or block forever. nullopt: `reason` says why.
#if !defined(_WIN32)
int open_regular_file(const std::filesystem::path&, std::uint64_t& size, std::string& reason); // a descriptor, or -1
#endif
std::optional<std::string> read_file(const std::filesystem::path&, std::string& reason);

// The file that `name` in a file of `folder` refers to; also if the name has backslashes, different case, or a folder
// of another machine (then the file in `folder` is used). Absolute; it may not exist.
std::filesystem::path find_file(const std::filesystem::path& folder, const std::string& name);

std::string lower(std::string_view); // ASCII
// "scene.obj" and "obj" (lower case)
bool has_extension(const char* path, std::string_view extension);

} // namespace restage::importing

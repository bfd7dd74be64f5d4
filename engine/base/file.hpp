// SPDX-License-Identifier: Apache-2.0
// Files and places: whole-file reading, atomic writing (temporary name, fsync, rename), a 64-bit content hash, and the
// folders this program uses. Paths are std::filesystem::path; messages show them as the user spelled them.
#pragma once

#include "base/result.hpp"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace restage {

constexpr std::uint64_t most_file_bytes = std::uint64_t{16} << 30; // default limit of read_file

// A regular file, open for reading: never a folder, a device, a pipe or a socket, which may be endless or block
// forever. Opening does not block either. Errors read "is a pipe, not a regular file".
class RegularFile {
  public:
    static Result<RegularFile> open(const std::filesystem::path&);
    RegularFile(RegularFile&&) noexcept;
    RegularFile& operator=(RegularFile&&) = delete;
    ~RegularFile();
    std::uint64_t size() const { return size_; } // when opened; 0 for files in /proc
    // Up to `most` bytes from where the last call ended; fewer only at the end.
    Result<std::string> read(std::uint64_t most);
    std::FILE* release(); // for std::fclose

  private:
    RegularFile(std::filesystem::path path, std::FILE* file, std::uint64_t size);
    std::filesystem::path path_;
    std::FILE* file_;
    std::uint64_t size_;
};

// The bytes of a regular file of at most `most` bytes. "scene.pbrt: cannot be opened: No such file or directory",
// "wood.png: is a pipe, not a regular file", "scene.bin: has 99 bytes, more than the 64 that are read".
Result<std::string> read_file(const std::filesystem::path&, std::uint64_t most = most_file_bytes);

// Readers see the old file or the complete new one, even after a crash. Missing folders are an error.
Result<> write_file_atomic(const std::filesystem::path&, std::string_view bytes);

// Likewise for a file too big for one string: write pieces, then commit. Without commit nothing changes.
class AtomicFile {
  public:
    static Result<AtomicFile> create(const std::filesystem::path&);
    AtomicFile(AtomicFile&&) noexcept;
    AtomicFile& operator=(AtomicFile&&) = delete;
    ~AtomicFile();
    Result<> write(std::string_view bytes);
    Result<> commit();

  private:
    AtomicFile(std::filesystem::path target, std::filesystem::path temporary, std::FILE* file);
    std::filesystem::path target_, temporary_;
    std::FILE* file_;
};

// XXH64 (Collet's specification). Chain pieces through the seed: hash64(b, hash64(a)). Identical on every machine.
std::uint64_t hash64(std::string_view bytes, std::uint64_t seed = 0);
std::uint64_t hash64(const void* data, std::size_t size, std::uint64_t seed = 0);

// Full path of the running program, and the folder it is in.
Result<std::filesystem::path> executable_path();
Result<std::filesystem::path> executable_dir();
// $XDG_CACHE_HOME/restage or ~/.cache/restage (%LOCALAPPDATA%\restage\cache); created.
Result<std::filesystem::path> cache_dir();
// $XDG_DATA_HOME/restage or ~/.local/share/restage (%APPDATA%\restage); not created. Users' plugins are in its
// `plugins`. An error if neither the variable nor a home is set.
Result<std::filesystem::path> user_data_dir();

} // namespace restage

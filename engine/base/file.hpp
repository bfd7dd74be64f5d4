// SPDX-License-Identifier: Apache-2.0
// Files and places: whole-file reading, atomic writing (temporary name, fsync, rename), a 64-bit content hash, and the
// folders this program uses. Paths are std::filesystem::path; messages show them in the user's own spelling.
#pragma once

#include "base/result.hpp"

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>

namespace restage {

// The bytes of a file. "scene.pbrt: cannot be read: No such file or directory"
Result<std::string> read_file(const std::filesystem::path&);

// Readers see the old file or the whole new one, also after a crash. Missing folders are an error.
Result<> write_file_atomic(const std::filesystem::path&, std::string_view bytes);

// The same for a file too big for one string: write pieces, then commit. Dropped without commit = nothing happened.
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

// XXH64 (Collet's specification). Chain pieces through the seed: hash64(b, hash64(a)). Same on every machine.
std::uint64_t hash64(std::string_view bytes, std::uint64_t seed = 0);
std::uint64_t hash64(const void* data, std::size_t size, std::uint64_t seed = 0);

// Full path of the running program, and the folder it is in.
Result<std::filesystem::path> executable_path();
Result<std::filesystem::path> executable_dir();
// $XDG_CACHE_HOME/restage or ~/.cache/restage (%LOCALAPPDATA%\restage\cache); created.
Result<std::filesystem::path> cache_dir();
// $XDG_DATA_HOME/restage or ~/.local/share/restage (%APPDATA%\restage); not created. Users' plugins are in its
// `plugins`. An error when neither the variable nor a home is set.
Result<std::filesystem::path> user_data_dir();

} // namespace restage

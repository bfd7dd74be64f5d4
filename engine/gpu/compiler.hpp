// SPDX-License-Identifier: Apache-2.0
// GLSL -> SPIR-V at run time, with includes, a disk cache, and errors that point to the original file and line.
// Any thread; many may compile at once.
#pragma once

#include "base/result.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace restage::gpu {

enum class ShaderStage { compute, raygen, closest_hit, any_hit, intersection, miss, callable };

struct ShaderSource {
    std::string name; // for errors: "shaders/wave_generate.comp", "<composed for diffuse>"
    std::string text; // begins with #version
    ShaderStage stage = ShaderStage::compute;
    std::vector<std::pair<std::string, std::string>> defines; // name, value
    // Files that exist in memory only: the name as in #include "name" -> text. They hide files on disk.
    std::map<std::string, std::string> files;
    // Searched before the compiler's own include folders.
    std::vector<std::filesystem::path> include_dirs;
    // Whose files #include <plugin/...> finds: <plugin/file> in the first, <plugin:1/file> in the second, and so on.
    // They are confined: they may include <restage/v1/...> from the compiler's folders and files of their own one,
    // declare no memory and use no built-in variables.
    std::vector<std::filesystem::path> plugin_folders = {};
    // Snapshots of files on disk, by absolute, lexically normal path: read instead of the disk. Some may be
    // null.
    std::vector<std::shared_ptr<const std::map<std::filesystem::path, std::string>>> texts = {};
};

struct Spirv {
    std::vector<std::uint32_t> words;
    std::string name;
    ShaderStage stage = ShaderStage::compute;
    std::string key; // of the disk cache: equal keys, equal words
    std::vector<std::filesystem::path> files; // what was included from disk, for reloading when one changes
    bool from_cache = false;
};

struct ShaderCompilerOptions {
    std::vector<std::filesystem::path> include_dirs;
    std::filesystem::path cache_dir; // empty: no cache. Usually restage::cache_dir() / "spirv"; it is created
    bool optimize = true; // a few cheap passes, mostly dead code elimination
    bool debug_info = false; // names and lines for debuggers and validation
};

class ShaderCompiler {
  public:
    explicit ShaderCompiler(ShaderCompilerOptions options);
    ~ShaderCompiler();
    ShaderCompiler(ShaderCompiler&&) noexcept;
    ShaderCompiler& operator=(ShaderCompiler&&) noexcept;

    // Includes are searched in `files`; next to the including file; in the source's include_dirs; in
    // the compiler's. `#pragma once` works. An error has one line per message: "oak/wood.glsl:12: 'x' : undeclared
    // identifier".
    Result<Spirv> compile(const ShaderSource& source) const;

  private:
    ShaderCompilerOptions options_;
};

} // namespace restage::gpu

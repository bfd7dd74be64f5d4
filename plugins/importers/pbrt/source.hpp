// SPDX-License-Identifier: Apache-2.0
// The text of the files an import reads, and places in it. Files are mapped or inflated once and kept until the end of
// the import, so that tokens can be views. ImportError is the one exception of this plugin; it never leaves it.
#pragma once

#include "common/bytes.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace restage::pbrt {

struct Location {
    std::uint32_t file = 0; // index into Sources
    std::uint32_t line = 0, column = 0; // 1-based; 0 = the file as a whole
};

struct Slip { // pbrt warns, or accepts it silently, and continues
    Location at;
    std::string what, note;
    bool only_v3 = false; // v4 stops there
};

struct ImportError { // "my format, but malformed"
    Location at;
    std::string message; // what is wrong and what to do about it
    bool stops_pbrt = false; // even within a shape that pbrt would otherwise skip
};

using importing::FileBytes;

class Sources {
  public:
    std::uint32_t add(std::string name, FileBytes bytes);
    const std::string& name(std::uint32_t file) const { return files_[file]->name; }
    std::string_view text(std::uint32_t file) const { return files_[file]->bytes.view(); }
    std::size_t size() const { return files_.size(); }

  private:
    struct File {
        std::string name;
        FileBytes bytes;
    };
    std::vector<std::unique_ptr<File>> files_;
};

// "/a/scene.pbrt:12:3"
std::string to_string(const Sources& sources, Location at);

} // namespace restage::pbrt

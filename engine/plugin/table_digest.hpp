// SPDX-License-Identifier: Apache-2.0
// Private to plugin/: the digest that identifies a revision of a material or a texture.
#pragma once

#include "base/file.hpp"
#include "plugin/material_source.hpp"

#include <string>
#include <string_view>

namespace restage::plugin {

// Numbers and texts of a table, concatenated: equal for equal tables.
class Digest {
  public:
    void text(std::string_view t) { hash_ = hash64(t, hash_ + 1); }
    template <class T>
    void number(T v) {
        hash_ = hash64(&v, sizeof v, hash_);
    }
    void param(const model::Param& p) {
        for (const std::string& t : {p.id, p.label, p.unit, choices_text(p), p.file, p.tooltip})
            text(t);
        for (const int n : {int(p.type), int(p.texturable), int(p.advanced), p.int_min, p.int_max, p.int_def})
            number(n);
        for (const float v : {p.min, p.max, p.def[0], p.def[1], p.def[2], p.def[3]})
            number(v);
    }
    void files(const FileTexts& glsl, const std::filesystem::path& folder) {
        for (const auto& [path, content] : glsl) {
            text(path.lexically_relative(folder).generic_string());
            text(content);
        }
    }
    std::uint64_t value() const { return hash_; }

  private:
    std::uint64_t hash_ = 0;
};

} // namespace restage::plugin

// SPDX-License-Identifier: Apache-2.0
// What tinyobjloader does not tell: on which line a name, a statement it skips, or a number it could not use stands.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace restage::obj {

struct Place {
    std::uint32_t line = 0, column = 0;
    std::string what;
};

struct ObjText {
    std::map<std::string, std::uint32_t> shapes;    // line of the first `o` or `g` of that name
    std::map<std::string, std::uint32_t> materials; // of the first `usemtl`
    std::map<std::string, std::uint32_t> libraries; // the rest of each `mtllib` line
    std::map<std::string, std::pair<std::uint32_t, std::uint32_t>> skipped; // statement -> first line, how often
};
ObjText scan_obj(std::string_view text);

struct MtlEntry {
    std::uint32_t line = 0;
    std::map<std::string, std::uint32_t> keys; // statement -> line
    bool has(const char* key) const { return keys.contains(key); }
};
std::map<std::string, MtlEntry> scan_mtl(std::string_view text); // by material name

enum class Find { vertex, attribute };
// The first vertex that is no three finite numbers, or face that names a vertex that is not there; or (attribute) face
// that names a texture coordinate or normal that is not there.
std::optional<Place> find_bad_number(std::string_view text, Find);

} // namespace restage::obj

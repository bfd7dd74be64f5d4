// SPDX-License-Identifier: Apache-2.0
// What a PLY header declares.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace restage::importing {

// Thrown. Where: a line of the header or of an ascii file, or a byte of a binary one; both 0 = of the whole file.
struct PlyProblem {
    std::string what;
    std::uint32_t line = 0;
    std::uint64_t byte = 0;
    std::string sentence() const; // "line 7: ..." or "byte 1234: ..."
};

enum class PlyType { i8, u8, i16, u16, i32, u32, f32, f64 };

struct PlyProperty {
    std::string name;
    PlyType type{};
    bool is_list = false;
    PlyType count_type{};
    std::size_t offset = 0; // in the row, if the element has no lists
};

struct PlyElement {
    std::string name;
    std::size_t count = 0;
    std::vector<PlyProperty> properties;
    bool has_lists = false;
    std::size_t stride = 0;
};

enum class PlyFormat { ascii, little, big };

struct PlyHeader {
    PlyFormat format = PlyFormat::ascii;
    std::vector<PlyElement> elements;
    std::vector<std::string> textures; // names in VCGLIB's `comment TextureFile` lines
    std::size_t size = 0; // [byte]; the data follow
};

std::size_t size_of(PlyType type);
PlyHeader read_ply_header(std::string_view bytes);

} // namespace restage::importing

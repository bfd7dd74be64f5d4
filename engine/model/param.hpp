// SPDX-License-Identifier: Apache-2.0
// Param: one line of a parameter table, which gives the inspector widget, undo, project file, script access, export,
// the GLSL struct and the fuzz range of a parameter. The engine's own type; plugin/ converts plugin declarations to it.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace restage::model {

enum class ParamType : std::uint8_t {
    number, // v[0]                                  GLSL float
    color, // v[0..2], linear sRGB primaries        GLSL vec3
    integer, // i                                     GLSL int
    boolean, // i, 0 or 1                             GLSL bool
    choice, // text, one of the line's choices       GLSL int, the index of the choice
    text, // text; not seen by shaders
    material, // a material of the scene; not seen by shaders
    texture, // a texture: a slot with no constant; not seen by BSDFs
    table // text, the absolute path of a file     GLSL Table
};

struct Param {
    std::string id; // lower_snake, unique in its table, a GLSL identifier
    std::string label;
    ParamType type = ParamType::number;
    bool texturable = false; // a texture may replace the constant: number, color
    bool advanced = false; // initially folded
    float min = 0, max = 1; // number, color: of each component; also the fuzz range
    std::array<float, 4> def{}; // number, color
    int int_min = 0, int_max = 0; // integer
    int int_def = 0; // integer; boolean: 0 or 1; choice: its index
    std::string unit; // "", "deg", "m", "1/m"
    std::vector<std::string> choices;
    std::string file; // table: the default, in the plugin's folder (absolute in a MaterialSource); "" = none
    std::string tooltip;

    bool ranged() const { return type == ParamType::number || type == ParamType::color || type == ParamType::integer; }
    int components() const { return type == ParamType::color ? 3 : 1; }
    // Index of a choice, or nullopt.
    std::optional<int> choice_index(std::string_view choice) const {
        for (std::size_t i = 0; i < choices.size(); ++i)
            if (choices[i] == choice) return static_cast<int>(i);
        return std::nullopt;
    }
    bool operator==(const Param&) const = default;
};

using ParamTable = std::span<const Param>;

inline const Param* find_param(ParamTable table, std::string_view id) { // null if there is none
    for (const Param& line : table)
        if (line.id == id) return &line;
    return nullptr;
}

// "v4|v3|none", for messages.
inline std::string choices_text(const Param& line) {
    std::string all;
    for (const std::string& choice : line.choices)
        all += (all.empty() ? "" : "|") + choice;
    return all;
}

} // namespace restage::model

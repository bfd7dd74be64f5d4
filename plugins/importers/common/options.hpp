// SPDX-License-Identifier: Apache-2.0
// Common options of importers: the unit of the file's lengths, and its up axis.
#pragma once

#include "common/matrix.hpp"
#include "common/stage.hpp"

#include <restage/scene_io.h>
#include <cstring>
#include <string_view>

namespace restage::importing {

inline constexpr RestageParam units_option =
    RESTAGE_ENUM_PARAM("units", "Units", "as_is|mm|cm|m|in|ft", 0, 0,
                       "What 1 is in the file: lengths become metres. as_is: they stay what they are");
inline constexpr RestageParam up_option = RESTAGE_ENUM_PARAM(
    "up", "Up", "as_is|y|z", 0, 0,
    "Which axis is up in the file: it becomes y, which is up in the scene. as_is: nothing is turned");

// Null if the host does not have it.
inline const RestageValue* option(const RestageSceneWriter1& out, const char* id) {
    if (out.size < offsetof(RestageSceneWriter1, option_count) + sizeof out.option_count) return nullptr;
    for (std::uint32_t i = 0; i < out.option_count; ++i)
        if (const RestageValue& v = RESTAGE_AT(RestageValue, out.options, i); std::strcmp(v.id, id) == 0) return &v;
    return nullptr;
}
inline std::string_view choice_option(const RestageSceneWriter1& out, const char* id) {
    const RestageValue* v = option(out, id);
    return v && v->text ? v->text : "";
}
inline bool flag_option(const RestageSceneWriter1& out, const char* id) {
    const RestageValue* v = option(out, id);
    return v && v->i != 0;
}

// From the file's space to the scene's.
struct Placement {
    Up up; // of the scene
    Matrix to_world;
    double metres = 1; // scene length of 1 unit of the file
    bool changes = false;

    Placement(const RestageSceneWriter1& out, Up of_format) : up(of_format) {
        const std::string_view axis = choice_option(out, "up"), unit = choice_option(out, "units");
        metres = unit == "mm" ? 0.001 : unit == "cm" ? 0.01 : unit == "in" ? 0.0254 : unit == "ft" ? 0.3048 : 1;
        if (axis == "y" || axis == "z") up = Up::y;
        if (axis == "z") to_world.set_column(1, {0, 0, -1}), to_world.set_column(2, {0, 1, 0});
        for (int c = 0; c < 3; ++c)
            to_world.set_column(c, to_world.column(c) * metres);
        changes = axis == "z" || metres != 1;
    }
    Matrix of(const Matrix& in_file) const { return changes ? to_world * in_file : in_file; } // else bit-identical
};

} // namespace restage::importing

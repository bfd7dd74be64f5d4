// SPDX-License-Identifier: Apache-2.0
// C++20 helpers for material tables: the lines of RestageParam as functions, checked at compile time. None of it
// crosses the ABI; C plugins do not need it.
#pragma once

#include <restage/material.h>
#include <array>
#include <cstdint>

namespace restage::sdk {

struct ParamText {
    const char* tooltip = "";
    const char* unit = "";
    bool texturable = false;
    bool advanced = false; // initially folded
};

namespace detail {
consteval RestageParam line(const char* id, const char* label, RestageType type, ParamText text) {
    RestageParam p{};
    p.id = id;
    p.label = label;
    p.type = type;
    if (text.texturable) p.flags |= RESTAGE_PARAM_TEXTURABLE;
    if (text.advanced) p.flags |= RESTAGE_PARAM_ADVANCED;
    p.unit = text.unit;
    p.tooltip = text.tooltip;
    return p;
}
} // namespace detail

// A default out of range does not compile.
consteval RestageParam number(const char* id, const char* label, float min, float max, float value,
                              ParamText text = {}) {
    RestageParam p = detail::line(id, label, RESTAGE_FLOAT, text);
    p.min = min, p.max = max;
    p.def[0] = value >= min && value <= max ? value : throw "the default is out of its range";
    return p;
}
consteval RestageParam integer(const char* id, const char* label, int min, int max, int value, ParamText text = {}) {
    RestageParam p = detail::line(id, label, RESTAGE_INT, text);
    p.int_min = min, p.int_max = max;
    p.int_def = value >= min && value <= max ? value : throw "the default is out of its range";
    return p;
}
// Linear sRGB primaries, each in [0, max].
consteval RestageParam color(const char* id, const char* label, std::array<float, 3> value, ParamText text = {},
                             float max = 1) {
    RestageParam p = detail::line(id, label, RESTAGE_COLOR, text);
    p.max = max;
    for (int i = 0; i < 3; ++i)
        p.def[i] = value[i] >= 0 && value[i] <= max ? value[i] : throw "the default is out of its range";
    return p;
}
consteval RestageParam toggle(const char* id, const char* label, bool value, ParamText text = {}) {
    RestageParam p = detail::line(id, label, RESTAGE_BOOL, text);
    p.int_max = 1;
    p.int_def = value ? 1 : 0;
    return p;
}
// `choices`: "ggx|beckmann"; `value`: the index of the default.
consteval RestageParam choice(const char* id, const char* label, const char* choices, int value, ParamText text = {}) {
    int count = 1;
    for (const char* c = choices; *c; ++c)
        count += *c == '|';
    RestageParam p = detail::line(id, label, RESTAGE_ENUM, text);
    p.choices = choices;
    p.int_def = value >= 0 && value < count ? value : throw "the default is not one of the choices";
    return p;
}

// `file`: the default, in the plugin's folder; nullptr = none.
consteval RestageParam table_file(const char* id, const char* label, const char* file, ParamText text = {}) {
    RestageParam p = detail::line(id, label, RESTAGE_TABLE, text);
    p.choices = file;
    return p;
}

} // namespace restage::sdk

// SPDX-License-Identifier: Apache-2.0
// How composed shaders read the value of a table line: `w` are words, the value's begin at index `at` + a number.
#pragma once

#include "model/param.hpp"

#include <fmt/format.h>
#include <cstdint>
#include <string>

namespace restage::render {

inline const char* glsl_type(const model::Param& p) {
    switch (p.type) {
        case model::ParamType::color:
            return "Spectrum";
        case model::ParamType::number:
            return "float";
        case model::ParamType::boolean:
            return "bool";
        case model::ParamType::table:
            return "Table";
        default:
            return "int";
    }
}

// RGB as the Spectrum that the plugin sees.
inline std::string spectrum(const model::Param& p, const std::string& rgb) {
    return fmt::format("{}({})", p.max <= 1 ? "spectrum_from_rgb" : "spectrum_from_rgb_unbounded", rgb);
}

inline std::string read_value(const model::Param& p, std::uint32_t at) {
    switch (p.type) {
        case model::ParamType::color:
            return fmt::format(
                "stored_spectrum(vec3(uintBitsToFloat(w.at[at + {}]), uintBitsToFloat(w.at[at + {}]), "
                "uintBitsToFloat(w.at[at + {}])))",
                at, at + 1, at + 2);
        case model::ParamType::number:
            return fmt::format("stored_number(w.at[at + {}])", at);
        case model::ParamType::boolean:
            return fmt::format("w.at[at + {}] != 0u", at);
        case model::ParamType::table:
            return fmt::format(
                "Table(uint64_t(w.at[at + {}]) | uint64_t(w.at[at + {}]) << 32, "
                "w.at[at + {}])",
                at, at + 1, at + 2);
        default:
            return fmt::format("int(w.at[at + {}])", at);
    }
}

} // namespace restage::render

// SPDX-License-Identifier: Apache-2.0
// Texture: what a texture plugin declares. Its code is GLSL, from which render/ composes a switch over types present.
#pragma once

#include "model/param.hpp"

#include <string>
#include <vector>

namespace restage::model {

struct Texture {
    std::string type; // "checkerboard": what scene files call it; unique over all plugins
    std::string label;
    std::string prefix; // of every GLSL name, without the underscore
    std::string glsl_file; // relative to the plugin's folder
    std::string tooltip;
    std::vector<Param> params; // texturable ones are operands
    bool image = false; // looks up the texture's image
    bool mapped = false; // uv comes through an affine map: uscale, vscale, ushear, vshear, udelta, vdelta, uvset
    bool site = false; // uses more of a TextureSite than uv

    const Param* find(std::string_view id) const { return find_param(params, id); }
    bool operator==(const Texture&) const = default;
};

// What every mapped texture has besides its own table: st = uv * scale + delta, and the other coordinate times shear.
inline const std::vector<Param>& mapping_params() {
    const auto line = [](const char* id, const char* label, float def, const char* tooltip) {
        return Param{
            .id = id, .label = label, .advanced = true, .min = -100, .max = 100, .def = {def}, .tooltip = tooltip};
    };
    static const std::vector<Param> lines = {
        line("uscale", "Repeat in u", 1, "How often it repeats along u"),
        line("vscale", "Repeat in v", 1, "How often it repeats along v"),
        line("udelta", "Shift in u", 0, "Added to u after the scale"),
        line("vdelta", "Shift in v", 0, "Added to v after the scale"),
        line("ushear", "Shear in u", 0, "How much of v is added to u"),
        line("vshear", "Shear in v", 0, "How much of u is added to v"),
        {.id = "uvset",
         .label = "UV set",
         .type = ParamType::integer,
         .advanced = true,
         .int_max = 1,
         .tooltip = "1: the second texture coordinates of the mesh, where it has them"},
    };
    return lines;
}

} // namespace restage::model

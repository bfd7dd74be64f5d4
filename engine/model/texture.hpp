// SPDX-License-Identifier: Apache-2.0
// Texture: the declaration of a texture plugin. Its code is GLSL; render/ composes a switch over the types in use.
#pragma once

#include "model/param.hpp"

#include <string>
#include <vector>

namespace restage::model {

struct Texture {
    std::string type; // "checkerboard": its name in scene files; unique over all plugins
    std::string label;
    std::string prefix; // of every GLSL name, without the underscore
    std::string glsl_file; // relative to the plugin's folder
    std::string tooltip;
    std::vector<Param> params; // texturable ones are operands
    bool image = false; // samples the texture's image
    bool mapped = false; // uv is transformed by an affine map: uscale, vscale, ushear, vshear, udelta, vdelta, uvset
    bool site = false; // uses more of a TextureSite than uv

    const Param* find(std::string_view id) const { return find_param(params, id); }
    bool operator==(const Texture&) const = default;
};

// Parameters of every mapped texture besides its table: st = uv * scale + delta + the other coordinate * shear.
inline const std::vector<Param>& mapping_params() {
    const auto line = [](const char* id, const char* label, float def, const char* tooltip) {
        return Param{
            .id = id, .label = label, .advanced = true, .min = -100, .max = 100, .def = {def}, .tooltip = tooltip};
    };
    static const std::vector<Param> lines = {
        line("uscale", "Repeat in u", 1, "Number of repetitions along u"),
        line("vscale", "Repeat in v", 1, "Number of repetitions along v"),
        line("udelta", "Shift in u", 0, "Added to u after the scale"),
        line("vdelta", "Shift in v", 0, "Added to v after the scale"),
        line("ushear", "Shear in u", 0, "Multiple of v added to u"),
        line("vshear", "Shear in v", 0, "Multiple of u added to v"),
        {.id = "uvset",
         .label = "UV set",
         .type = ParamType::integer,
         .advanced = true,
         .int_max = 1,
         .tooltip = "1: the mesh's second texture coordinates, if it has them"},
    };
    return lines;
}

} // namespace restage::model

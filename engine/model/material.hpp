// SPDX-License-Identifier: Apache-2.0
// Material: what a material plugin declares. Its BSDF is GLSL, which render/ composes with the table.
#pragma once

#include "model/param.hpp"

#include <optional>
#include <string>
#include <vector>

namespace restage::model {

// The parameters of a material's emission: L = radiance * scale [W/(m^2 sr)].
struct Emission {
    std::string radiance;  // a color, perhaps textured
    std::string scale;     // a number without texture; "" = 1
    std::string two_sided; // a boolean; "" = only the outer side emits
    bool operator==(const Emission&) const = default;
};

struct Material {
    std::string type; // "conductor": its name in scene files; unique over all plugins
    std::string label;
    std::string prefix;    // of every GLSL name, without the underscore
    std::string glsl_file; // relative to the plugin's folder; "" for mixes and null surfaces
    std::string tooltip;
    std::vector<Param> params;
    std::optional<Emission> emission; // nullopt = does not emit

    bool stochastic = false;    // eval, pdf and sample take an Rng
    bool lossless = false;      // the white furnace gives 1 at the defaults
    bool transmissive = false;  // may scatter to the other side
    bool nonreciprocal = false; // f(wo, wi) != f(wi, wo), declared
    bool null_surface = false;  // rays pass through (pbrt's `interface`)
    bool mix = false;           // chooses between its parameters `first` and `second` by `amount`
    bool tangent = false;       // the frame's x axis follows dp/du
    bool site = false;          // eval, pdf, sample and albedo take a Site
    bool additive = false;      // energy <= 1 only while its colours, except "opacity", sum to at most 1

    const Param* find(std::string_view id) const { return find_param(params, id); }
    bool has_code() const { return !mix && !null_surface; }
    bool operator==(const Material&) const = default;
};

// Parameters every material has besides its own table.
inline const std::vector<Param>& surface_params() {
    static const std::vector<Param> lines = {
        {.id = "bump",
         .label = "Bump map",
         .type = ParamType::texture,
         .tooltip = "Heights in scene units that tilt the shading normal"},
        {.id = "normalmap",
         .label = "Normal map",
         .type = ParamType::texture,
         .tooltip = "Tangent-space normals, as used in games"},
    };
    return lines;
}

} // namespace restage::model

// SPDX-License-Identifier: Apache-2.0
// Texture: what a texture plugin declares. Its code is GLSL, of which render/ composes a switch over the types present.
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

} // namespace restage::model

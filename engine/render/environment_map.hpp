// SPDX-License-Identifier: Apache-2.0
// The environment as texels with an alias table over their power, and its mean over the sphere. Shaders
// interpolate between texels, the light-sampling density as well as the radiance (shaders/lib/light.glsl).
#pragma once

#include "scene/scene.hpp"
#include "shared/scene_data.h"

#include <vector>

namespace restage::render {

struct EnvironmentMap {
    std::uint32_t width = 0, height = 0;
    std::vector<glm::vec4> texels;         // rgb and pmf * number of texels, row 0 on top; empty for a constant
    std::vector<shared::AliasEntry> alias; // weight: luminance * solid angle of the texel
    glm::vec3 mean{0};                     // over the sphere, without scale
    std::size_t mended = 0;                // number of negative or non-finite values, replaced by 0
};

// A black image, or none, gives an empty map with mean 0 (black image) or 1 (constant).
EnvironmentMap make_environment_map(const scene::PixelData*, scene::Mapping);

} // namespace restage::render

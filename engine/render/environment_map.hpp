// SPDX-License-Identifier: Apache-2.0
// The environment as texels, with tables to draw directions by their luminance, and its mean over the sphere. Shaders
// interpolate between texels, the light-sampling density as well as the radiance (shaders/lib/environment.glsl).
#pragma once

#include "scene/scene.hpp"
#include "shared/scene_data.h"

#include <vector>

namespace restage::render {

struct EnvironmentMap {
    std::uint32_t width = 0, height = 0;
    std::vector<glm::vec4> texels; // rgb and density over the unit square, row 0 on top; empty for a constant
    // Cells between the middles of neighbouring texels, where the density is bilinear: (width + 1) * (height + 1),
    // those at the edges halved.
    std::vector<shared::CdfEntry> rows;    // height + 1: rows of cells
    std::vector<shared::CdfEntry> columns; // width + 1 for each row
    glm::vec3 mean{0};                     // over the sphere, without scale
    float focus = 0; // share of its power that comes from its brightest 0.1 sr: near 1 for a sky with a sun
    std::size_t mended = 0;                // number of negative or non-finite values, replaced by 0
};

// A black image, or none, gives an empty map with mean 0 (black image) or 1 (constant). compensate: directions darker
// than the mean are left to BSDF sampling, which must then be in use too (MIS compensation: Karlik et al. 2019).
EnvironmentMap make_environment_map(const scene::PixelData*, scene::Mapping, bool compensate);

} // namespace restage::render

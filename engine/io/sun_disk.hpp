// SPDX-License-Identifier: Apache-2.0
// Draws a sun into an environment image: texels get the part of the disk that they cover, and their sum is the disk's
// energy, radiance times solid angle, at any resolution.
#pragma once

#include "scene/scene.hpp"

#include <glm/glm.hpp>

namespace restage::io {

struct Sun {
    glm::dvec3 direction{0, 0, 1}; // unit, in the sky's frame
    glm::vec3 radiance{0};
    double angular_radius = 0.00465; // [rad]
};

double solid_angle(const Sun&); // [sr]
// The direction of a point of an equal-area octahedral image, in texels: restage_sky_direction().
glm::dvec3 octahedral_direction(std::uint32_t width, double x, double y);
// `picture`: square, equal-area octahedral, 3 channels.
void draw_sun(scene::PixelData& picture, const Sun&);

// Averages blocks of texels; texels have equal areas, so the energy is preserved. Unchanged if it is not wider.
scene::PixelData coarse_sky(const scene::PixelData& picture, std::uint32_t width);

} // namespace restage::io

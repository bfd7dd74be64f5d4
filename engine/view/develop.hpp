// SPDX-License-Identifier: Apache-2.0
// Developing: radiance to 8 bits. In this order: exposure, bloom, vignette, white balance, tone curve, backdrop, sRGB.
#pragma once

#include "scene/scene.hpp"

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace restage::view {

// Tone curves, from linear sRGB to linear sRGB in [0,1]:
// - srgb: clipped;
// - filmic: per channel, Narkowicz, "ACES filmic tone mapping curve", 2016;
// - agx: Sobotka's AgX with its base contrast: the sigmoid of 16.5 stops in his AgX-S2O3 (slope 2, powers 3 and 3.25,
//   middle grey at 0.5), between the inset of Blender 4's AgX in Rec. 2020 and the outset that Filament inverts;
// - neutral: Khronos PBR Neutral, specification 1.0.
// Black stays black, and greys stay grey and in order. Infinite values are white, NaN black.
struct Developing {
    scene::Development how;
    float factor = 1; // on the radiance: the exposure
    glm::vec4 window{0, 1, 0, 1}; // x0 x1 y0 y1 of the picture in the film, for the vignette: Film::crop
    std::span<const float> coverage = {}; // of each pixel, for a backdrop; empty: none is shown
};

// `color`: width * height pixels of linear sRGB, row 0 on top. `rgba`: as many, red in the lowest byte. Alpha, not
// premultiplied, is 255 unless the backdrop is transparent; light that covers nothing (bloom) raises it.
// 1280x720 takes 3 ms (srgb, filmic) to 8 ms (agx) on one thread of a 2-core server; vignette 2 ms, bloom 8 ms more.
// [any]
void develop(std::span<const glm::vec3> color, std::uint32_t width, std::uint32_t height, const Developing&,
             std::uint32_t* rgba);

// `color` with the fraction `amount` of its light scattered by a kernel that falls off as 1/r^2, as the glare of lenses
// and eyes does beyond a few pixels (Spencer et al., "Physically-based glare effects for digital images", 1995): six
// octaves, from half the picture's height down, of equal energy. No light is added; a picture of one colour stays
// as it is. Octaves narrower than two pixels are not scattered.
std::vector<glm::vec3> bloomed(std::span<const glm::vec3> color, std::uint32_t width, std::uint32_t height,
                               float amount);

} // namespace restage::view

// SPDX-License-Identifier: Apache-2.0
// Sky blur: the image of an environment, softened over the sphere.
#pragma once

#include "base/result.hpp"
#include "scene/edit.hpp"

namespace restage::scene {

inline constexpr double least_blur = 0.5; // [deg]
// A square octahedral map of the same sky (its frame, +z up), convolved with exp((cos - 1) / s^2), the von Mises-Fisher
// kernel, a Gaussian of standard deviation s for small angles. `degrees`: s, from least_blur to 180. The mean over the
// sphere, and with it the light of a sun in it, stays, for each channel; a constant sky stays as it is; what is not
// finite or negative counts as 0. Three channels. [any]
PixelData blurred_sky(const PixelData& pixels, Mapping mapping, double degrees);

// The environment's image becomes its blurred one, kept in memory; one that a sky plugin made is no longer that.
// Errors: it has no image, or the image no pixels; an angle out of range.
Result<Edit> blur_sky(const Scene&, double degrees);
// Likewise, with what blurred_sky() returned for it.
Edit set_blurred_sky(const Scene&, PixelData blurred);

} // namespace restage::scene

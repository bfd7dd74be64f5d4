// SPDX-License-Identifier: Apache-2.0
// What shadow catchers do to a picture. shaders/path/catcher.glsl makes their layers of the film: what is behind a
// catcher is multiplied by the light that it would reflect, as a white diffuse surface, with the objects of the scene,
// divided by that without them. The ratio is of a pixel's means: consistent, and 1 exactly where nothing is in the way.
#pragma once

#include "render/film_layers.hpp"

#include <span>

namespace restage::render {

// Whether some pixel shows a catcher. All of the following need it.
inline bool has_catchers(const FilmImage& image) { return !image.caught.empty(); }

// For each pixel, per channel, above 0; 1 where there is no catcher, or none that is lit.
std::vector<glm::vec3> shadow_ratios(const FilmImage&);

// `alpha`, for these ratios of each pixel: of a catcher, 1 - min(1, luminance with / luminance without).
void set_alpha(FilmImage&, std::span<const glm::vec3> ratios);
// Multiplies what is behind catchers by `ratios`, and sets alpha.
void add_shadows(FilmImage&, std::span<const glm::vec3> ratios);
// The inverse, of shadow_ratios() for the colours: `color` is the picture without shadows on catchers.
void remove_shadows(FilmImage&);
// Errors on catchers, from those of L_with - L_without, which a film measures, to those of the picture; without twins.
void scale_errors(FilmImage&);

} // namespace restage::render

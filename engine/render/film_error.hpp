// SPDX-License-Identifier: Apache-2.0
// The standard error of pixels whose samples are stratified, so not independent of each other. Their spread says what
// it would be without the stratification, and is precise; the difference between a pixel and its twin, rendered with
// other random numbers, is right, but a single number, for one pixel of 32 (shared/twins.h). So: the spread, times the
// mean ratio of the two among the twins nearby.
#pragma once

#include "render/film_layers.hpp"

namespace restage::render {

double luminance(const glm::dvec3& linear_srgb);

// Sets std_error and luminance_variance from sample_error, twin, and luminance_variance, which is as if samples were
// independent.
void correct_errors(FilmImage& film);

// Of a film with corrected errors: what luminance_variance was before.
float independent_variance(const FilmImage& film, std::size_t pixel);

// Root mean square over pixels of (standard error of luminance / (luminance + 0.01)), the measure of --error; 1e30 with
// fewer than two samples. Luminance counts up to that of the brightest neighbour.
double relative_error(const FilmImage& film);

} // namespace restage::render

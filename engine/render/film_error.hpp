// SPDX-License-Identifier: Apache-2.0
// The standard error of pixels whose samples are stratified, so not independent of each other. Their spread says what
// it would be without the stratification, and is precise; the difference between a pixel and its twin, rendered with
// other random numbers, is right, but a single number, for one pixel of 32 (shared/twins.h). So: the spread, times the
// mean ratio of the two among the twins nearby.
#pragma once

#include "render/film_layers.hpp"

#include <cstdint>

namespace restage::render {

double luminance(const glm::dvec3& linear_srgb);

// Sets std_error and luminance_variance from sample_error, twin, and luminance_variance, which is as if samples were
// independent.
void correct_errors(FilmImage& film);

// Of a film with corrected errors: what luminance_variance was before.
float independent_variance(const FilmImage& film, std::size_t pixel);

// Root mean square over pixels of (standard error of luminance / (luminance + 0.01)), the measure of --error; 1e30 with
// fewer than two samples. Where a pixel is noisy, its luminance is that of its neighbours.
double relative_error(const FilmImage& film);

// A rendering to a relative error looks at it at some numbers of samples per pixel only, from 16 on four times per
// doubling: so the stop depends on the samples, not on batches, and a moment of luck rarely ends it.
std::uint32_t next_look(std::uint32_t samples); // the first such number above `samples`
inline bool is_look(std::uint32_t samples) { return samples > 0 && next_look(samples - 1) == samples; }

} // namespace restage::render

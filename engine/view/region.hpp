// SPDX-License-Identifier: Apache-2.0
// A part of a picture that was rendered alone, put into the picture around it.
#pragma once

#include "render/film_layers.hpp"

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

namespace restage::view {

// `around` at this size (nearest pixels, if it has another one), with the pixels of `part` at `lower`. Parts beyond the
// picture are cut. What is about the whole (FilmImage::samples) is the part's.
render::FilmImage with_part(const render::FilmImage& around, glm::uvec2 size, const render::FilmImage& part,
                            glm::uvec2 lower);
// Likewise numbers of samples; an empty `around` has 0 everywhere.
std::vector<std::uint32_t> with_part(const std::vector<std::uint32_t>& around, glm::uvec2 around_size, glm::uvec2 size,
                                     const std::vector<std::uint32_t>& part, glm::uvec2 part_size, glm::uvec2 lower);

} // namespace restage::view

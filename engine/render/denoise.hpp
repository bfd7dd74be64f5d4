// SPDX-License-Identifier: Apache-2.0
// Denoising through a plugin: the film's picture and guides in, a clean picture out.
#pragma once

#include "base/result.hpp"
#include "plugin/registry.hpp"
#include "render/film.hpp"

#include <functional>

namespace restage::render {

// Same size and units as image.color. [any], one at a time per plugin. `keep_going` may stop it: an error then.
Result<std::vector<glm::vec3>> denoise(const FilmImage& image, const plugin::DenoiserEntry& denoiser,
                                       RestageDenoiseQuality quality, unsigned threads = 0,
                                       std::function<bool(double done)> keep_going = {});

} // namespace restage::render

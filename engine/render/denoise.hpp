// SPDX-License-Identifier: Apache-2.0
// Denoising through a plugin: the film's picture and guides in, a clean picture out.
#pragma once

#include "base/result.hpp"
#include "plugin/registry.hpp"
#include "render/film.hpp"

#include <functional>
#include <string>

namespace restage::render {

// The denoiser of this type ("oidn") or of the plugin of this id. "": the one shipped with the program, if
// available, else the first available one. An error lists the known ones, or says why none is available.
Result<plugin::DenoiserEntry> choose_denoiser(const plugin::Registry&, const std::string& name);
// For the file: "oidn high".
std::string denoiser_label(const plugin::DenoiserEntry&, plugin::DenoiseQuality);

// Same size and units as image.color. [any], one at a time per plugin. `keep_going` may stop it: the error is then
// of kind `cancelled`. Shadows on catchers are denoised apart from what they fall on, in twice the time; image.alpha is
// then that of the clean shadows.
Result<std::vector<glm::vec3>> denoise(FilmImage& image, const plugin::DenoiserEntry& denoiser,
                                       plugin::DenoiseQuality quality, unsigned threads = 0,
                                       std::function<bool(double done)> keep_going = {});

} // namespace restage::render

// SPDX-License-Identifier: Apache-2.0
// Film images as pictures for io/image_compare.hpp.
#pragma once

#include "render/film.hpp"
#include "scene/scene.hpp"

namespace restage::bench {

inline scene::PixelData picture(const std::vector<glm::vec3>& color, const render::FilmImage& film, float scale = 1) {
    scene::PixelData p{.width = film.width, .height = film.height, .channels = 3, .values = {}};
    p.values.reserve(color.size() * 3);
    for (const glm::vec3& c : color)
        for (int k = 0; k < 3; ++k)
            p.values.push_back(c[k] * scale);
    return p;
}

inline scene::PixelData mean(scene::PixelData a, const scene::PixelData& b) {
    for (std::size_t i = 0; i < a.values.size(); ++i)
        a.values[i] = 0.5f * (a.values[i] + b.values[i]);
    return a;
}

} // namespace restage::bench

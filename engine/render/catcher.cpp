// SPDX-License-Identifier: Apache-2.0
#include "render/catcher.hpp"

#include "render/film_error.hpp"

#include <algorithm>

namespace restage::render {

std::vector<glm::vec3> shadow_ratios(const FilmImage& image) {
    std::vector<glm::vec3> ratios(image.pixels(), glm::vec3(1));
    for (std::size_t i = 0; i < ratios.size(); ++i)
        for (int k = 0; k < 3; ++k)
            if (const float without = image.without[i][k]; without > 0)
                ratios[i][k] = std::max(0.f, 1 + image.shade[i][k] / without);
    return ratios;
}

void set_alpha(FilmImage& image, std::span<const glm::vec3> ratios) {
    image.alpha = image.coverage;
    for (std::size_t i = 0; i < ratios.size(); ++i) {
        if (image.caught[i] == 0) continue;
        const double light = luminance(image.without[i]);
        const double kept = light > 0 ? luminance(image.without[i] * ratios[i]) / light : 1;
        image.alpha[i] -= image.caught[i] * float(std::clamp(kept, 0.0, 1.0));
    }
}

void add_shadows(FilmImage& image, std::span<const glm::vec3> ratios) {
    set_alpha(image, ratios);
    for (std::size_t i = 0; i < ratios.size(); ++i)
        image.color[i] += image.backdrop[i] * (ratios[i] - 1.f);
}

void remove_shadows(FilmImage& image) {
    const std::vector<glm::vec3> ratios = shadow_ratios(image);
    for (std::size_t i = 0; i < ratios.size(); ++i)
        image.color[i] -= image.backdrop[i] * (ratios[i] - 1.f);
}

void scale_errors(FilmImage& image) {
    for (std::size_t i = 0; i < image.pixels(); ++i) {
        if (image.caught[i] == 0) continue;
        glm::vec3 behind(0); // where no light comes the ratio is 1, without error
        for (int k = 0; k < 3; ++k)
            if (image.without[i][k] > 0) behind[k] = image.backdrop[i][k] / image.without[i][k];
        const double light = luminance(image.without[i]);
        const double factor = light > 0 ? luminance(image.backdrop[i]) / light : 0;
        // Beside other objects in the pixel, both count.
        image.std_error[i] *= glm::mix(glm::vec3(1), behind, image.caught[i]);
        image.sample_error[i] *= glm::mix(glm::vec3(1), behind, image.caught[i]);
        image.luminance_variance[i] *= float(glm::mix(1.0, factor * factor, double(image.caught[i])));
        image.twin[i] = glm::vec2(0);
    }
}

} // namespace restage::render

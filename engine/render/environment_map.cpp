// SPDX-License-Identifier: Apache-2.0
#include "render/environment_map.hpp"

#include "render/alias_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace restage::render {

EnvironmentMap make_environment_map(const scene::PixelData* image, scene::Mapping mapping) {
    EnvironmentMap map;
    if (!image || image->width == 0 || image->height == 0) {
        map.mean = glm::vec3(1);
        return map;
    }
    map.width = image->width;
    map.height = image->height;
    const std::size_t n = std::size_t(map.width) * map.height;
    map.texels.resize(n);
    std::vector<double> weights(n);
    glm::dvec3 sum(0);
    double total = 0;
    for (std::uint32_t y = 0; y < map.height; ++y) {
        // Solid angle of a row's texels, exact: the difference of the cosines at its edges.
        const double row = mapping == scene::Mapping::equirect ? std::cos(std::numbers::pi * y / map.height) -
                                                                     std::cos(std::numbers::pi * (y + 1) / map.height)
                                                               : 1.0;
        for (std::uint32_t x = 0; x < map.width; ++x) {
            const std::size_t i = std::size_t(y) * map.width + x;
            const float* v = &image->values[i * image->channels];
            glm::vec3 c = image->channels >= 3 ? glm::vec3(v[0], v[1], v[2]) : glm::vec3(v[0]);
            for (int k = 0; k < 3; ++k)
                if (!(std::isfinite(c[k]) && c[k] >= 0)) {
                    c[k] = 0;
                    ++map.mended;
                }
            map.texels[i] = glm::vec4(c, 0);
            weights[i] = row * (0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z);
            sum += row * glm::dvec3(c);
            total += row;
        }
    }
    map.mean = glm::vec3(sum / total);
    map.alias = make_alias_table(weights);
    if (map.alias.empty()) map.texels.clear();
    for (std::size_t i = 0; i < map.texels.size(); ++i)
        map.texels[i].w = map.alias[i].pmf * float(n);
    return map;
}

} // namespace restage::render

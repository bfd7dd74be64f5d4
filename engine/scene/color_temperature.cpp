// SPDX-License-Identifier: Apache-2.0
#include "scene/color_temperature.hpp"

#include <algorithm>

namespace restage::scene {

namespace {
// IEC 61966-2-1, D65; rows are R, G, B.
const glm::dmat3 xyz_to_srgb =
    glm::transpose(glm::dmat3(3.2404542, -1.5371385, -0.4985314, // first row
                              -0.9692660, 1.8760108, 0.0415560, 0.0556434, -0.2040259, 1.0572252));
} // namespace

glm::dvec3 blackbody_color(double kelvin) {
    const double t = std::clamp(kelvin, least_kelvin, most_kelvin);
    const double x = t <= 4000 ? -0.2661239e9 / (t * t * t) - 0.2343589e6 / (t * t) + 0.8776956e3 / t + 0.179910
                               : -3.0258469e9 / (t * t * t) + 2.1070379e6 / (t * t) + 0.2226347e3 / t + 0.240390;
    const double y = t <= 2222   ? -1.1063814 * x * x * x - 1.34811020 * x * x + 2.18555832 * x - 0.20219683
                     : t <= 4000 ? -0.9549476 * x * x * x - 1.37418593 * x * x + 2.09137015 * x - 0.16748867
                                 : 3.0817580 * x * x * x - 5.87338670 * x * x + 3.75112997 * x - 0.37001483;
    const glm::dvec3 rgb = glm::max(xyz_to_srgb * glm::dvec3(x / y, 1, (1 - x - y) / y), glm::dvec3(0));
    return rgb / std::max({rgb.x, rgb.y, rgb.z});
}

double color_temperature(const glm::dvec3& rgb) {
    const glm::dvec3 xyz = glm::inverse(xyz_to_srgb) * rgb;
    const double sum = xyz.x + xyz.y + xyz.z;
    if (!(sum > 0)) return 0;
    const double x = xyz.x / sum, y = xyz.y / sum;
    if (y <= 0.1858) return 0; // on the wrong side of McCamy's epicentre
    const double n = (x - 0.3320) / (0.1858 - y);
    const double t = ((449 * n + 3525) * n + 6823.3) * n + 5520.33;
    return t >= 1000 && t <= 30000 ? t : 0;
}

} // namespace restage::scene

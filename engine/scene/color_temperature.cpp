// SPDX-License-Identifier: Apache-2.0
#include "scene/color_temperature.hpp"

#include <algorithm>

namespace restage::scene {

namespace {
// IEC 61966-2-1, D65; rows are R, G, B.
const glm::dmat3 xyz_to_srgb =
    glm::transpose(glm::dmat3(3.2404542, -1.5371385, -0.4985314, // first row
                              -0.9692660, 1.8760108, 0.0415560, 0.0556434, -0.2040259, 1.0572252));

// Kim's splines of the Planckian locus, xy.
glm::dvec2 planckian(double t) {
    const double x = t <= 4000 ? -0.2661239e9 / (t * t * t) - 0.2343589e6 / (t * t) + 0.8776956e3 / t + 0.179910
                               : -3.0258469e9 / (t * t * t) + 2.1070379e6 / (t * t) + 0.2226347e3 / t + 0.240390;
    const double y = t <= 2222   ? -1.1063814 * x * x * x - 1.34811020 * x * x + 2.18555832 * x - 0.20219683
                     : t <= 4000 ? -0.9549476 * x * x * x - 1.37418593 * x * x + 2.09137015 * x - 0.16748867
                                 : 3.0817580 * x * x * x - 5.87338670 * x * x + 3.75112997 * x - 0.37001483;
    return {x, y};
}

// CIE daylight, xy; from 4000 K.
glm::dvec2 daylight(double t) {
    const double x = t <= 7000 ? -4.6070e9 / (t * t * t) + 2.9678e6 / (t * t) + 0.09911e3 / t + 0.244063
                               : -2.0064e9 / (t * t * t) + 1.9018e6 / (t * t) + 0.24748e3 / t + 0.237040;
    return {x, (-3 * x + 2.870) * x - 0.275};
}

glm::dvec2 on_line(double t) {
    const double share = std::clamp((t - 4000) / 1000, 0.0, 1.0);
    return share == 0 ? planckian(t) : share == 1 ? daylight(t) : glm::mix(planckian(t), daylight(t), share);
}

// CIE 1960, and back.
glm::dvec2 to_uv(glm::dvec2 xy) { return glm::dvec2(4 * xy.x, 6 * xy.y) / (-2 * xy.x + 12 * xy.y + 3); }
glm::dvec2 to_xy(glm::dvec2 uv) { return glm::dvec2(3 * uv.x, 2 * uv.y) / (2 * uv.x - 8 * uv.y + 4); }

glm::dvec3 white_of(glm::dvec2 xy) { return {xy.x / xy.y, 1, (1 - xy.x - xy.y) / xy.y}; }

} // namespace

glm::dvec3 blackbody_color(double kelvin) {
    const glm::dvec2 xy = planckian(std::clamp(kelvin, least_kelvin, most_kelvin));
    const glm::dvec3 rgb = glm::max(xyz_to_srgb * white_of(xy), glm::dvec3(0));
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

glm::dvec2 illuminant(double kelvin, double tint) {
    const double t = std::clamp(kelvin, least_kelvin, most_kelvin);
    const glm::dvec2 at = on_line(t);
    if (tint == 0) return at;
    const glm::dvec2 along = glm::normalize(to_uv(on_line(t * 1.001)) - to_uv(on_line(t * 0.999))); // to the cold end
    return to_xy(to_uv(at) + glm::dvec2(along.y, -along.x) * (tint / 3000));
}

glm::dmat3 white_balance(double kelvin, double tint) {
    if (kelvin == daylight_kelvin && tint == 0) return glm::dmat3(1);
    const glm::dmat3 cones = glm::transpose(
        glm::dmat3(0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296)); // Bradford, from XYZ
    const glm::dvec3 scale =
        (cones * white_of(illuminant(daylight_kelvin, 0))) / (cones * white_of(illuminant(kelvin, tint)));
    const glm::dmat3 adapt = glm::inverse(cones) * glm::dmat3(scale.x, 0, 0, 0, scale.y, 0, 0, 0, scale.z) * cones;
    return xyz_to_srgb * adapt * glm::inverse(xyz_to_srgb);
}

} // namespace restage::scene

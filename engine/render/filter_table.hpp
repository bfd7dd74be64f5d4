// SPDX-License-Identifier: Apache-2.0
// Pixel filters for importance sampling: box and triangle in closed form in the shader, the others tabulated per axis
// (all of pbrt's are separable). pbrt 4ed, 8.8.
#pragma once

#include "scene/scene.hpp"

#include <vector>

namespace restage::render {

// The filter along one axis (0 = x), at distance x [pixel]; not normalised. Gaussian: shifted to 0 at the radius.
double filter_value(const scene::Filter&, int axis, double x);

struct FilterTable {
    std::uint32_t entries = 0;
    std::vector<float> data; // cdf_x[n+1], cdf_y[n+1], sign_x[n], sign_y[n]
    glm::vec2 weight{1};     // integral of |f| / integral of f
};
FilterTable make_filter_table(const scene::Filter&);

} // namespace restage::render

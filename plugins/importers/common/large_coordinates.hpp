// SPDX-License-Identifier: Apache-2.0
// Map coordinates (UTM, millions of metres) have more digits than a float: the mesh is stored relative to
// its own origin, and the instance's transform, which is double, moves it back.
#pragma once

#include "common/matrix.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace restage::importing {

// 3 per vertex, finite. `origin` stays 0 if floats are sufficient: their rounding, 2^-24 of the largest coordinate,
// is below a millionth of the size of what they describe.
inline std::vector<float> recentred(const std::vector<double>& positions, Vec3& origin) {
    Bounds bounds;
    for (std::size_t i = 0; i + 2 < positions.size(); i += 3)
        bounds.add({positions[i], positions[i + 1], positions[i + 2]});
    double largest = 0;
    for (std::size_t c = 0; c < 3; ++c)
        largest = std::max({largest, std::abs(bounds.lower[c]), std::abs(bounds.upper[c])});
    origin = {0, 0, 0};
    if (!bounds.empty() && largest / (1 << 24) > 1e-6 * 2 * bounds.radius())
        for (std::size_t c = 0; c < 3; ++c)
            origin[c] = std::round(bounds.center()[c]);
    std::vector<float> result(positions.size());
    for (std::size_t i = 0; i < positions.size(); ++i)
        result[i] = static_cast<float>(positions[i] - origin[i % 3]);
    return result;
}

} // namespace restage::importing

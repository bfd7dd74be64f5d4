// SPDX-License-Identifier: Apache-2.0
// Polygons become triangles.
#pragma once

#include "common/matrix.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace restage::importing {

// Cuts the polygon with these corners, in order, into at most corners.size() - 2 triangles of the same sense: indices
// into `corners`, three each, appended to `out`. Convex ones become a fan of the first corner; others lose ear after
// ear in the plane that fits best (Meisters 1975; the least-squares normal is Newell's), so that their area is kept
// for any number of corners. The rest of a self-intersecting one becomes a fan. Returns how far the
// corners are from that plane, relative to the polygon's size: 0 = flat.
double cut_polygon(std::span<const Vec3> corners, std::vector<std::uint32_t>& out);

} // namespace restage::importing

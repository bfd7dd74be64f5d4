// SPDX-License-Identifier: Apache-2.0
// Points and lines have no surface to render: if a file contains nothing else they get a thickness.
#pragma once

#include "common/mesh.hpp"

#include <cstddef>
#include <span>

namespace restage::importing {

inline constexpr std::size_t most_strokes = 1'000'000; // more are thinned out evenly

struct Strokes {
    MeshBuffer mesh;
    double radius = 0;
    std::size_t triangles_each = 0; // of the k-th point or line: triangles k * triangles_each and on
    std::size_t step = 1;           // every step-th was kept
};

// An octahedron per point; a third of the mean distance of points spread over a surface of the cloud's size.
Strokes thick_points(std::span<const float> positions, std::span<const std::uint32_t> points);
// A square bar per line (two points); a three-hundredth of the total size.
Strokes thick_lines(std::span<const float> positions, std::span<const std::uint32_t> lines);

} // namespace restage::importing

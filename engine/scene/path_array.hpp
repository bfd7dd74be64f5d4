// SPDX-License-Identifier: Apache-2.0
// Arrays along a path: displacements of copies that stand at equal distances along a line through points in the world.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace restage::scene {

// The line through the points, as short straight pieces: the points themselves, or a centripetal Catmull-Rom spline
// (Barry and Goldman 1988; Yuksel et al. 2011), which has no loops or cusps between them. Points equal to the one
// before are left out.
std::vector<glm::dvec3> path_through(std::span<const glm::dvec3> points, bool smooth);
double length_of(std::span<const glm::dvec3> path);

struct PathArray {
    int count = 5; // with the original; it is at the first point, the last copy at the last one
    double spacing = 0; // > 0: the distance along the path, instead of a count
    glm::dvec3 up{0, 1, 0}; // unit
    bool turn = true; // about `up`, with the path; else all keep their direction
};
// `path`: of path_through. Without the original's place, which is its beginning; empty for a path without length. At
// most as many as duplicate_each takes.
std::vector<glm::dmat4> path_array(std::span<const glm::dvec3> path, const PathArray&);

} // namespace restage::scene

// SPDX-License-Identifier: Apache-2.0
// The displacements at which two convex bodies overlap are a convex polyhedron, and faces of that of two triangles have
// one of 11 normals: of either triangle, or perpendicular to an edge of each. A motion is a ray, clipped at each of
// these pairs of planes (Cyrus and Beck 1978); as a test over time of intervals on separating axes: Ericson, Real-Time
// Collision Detection (2005), section 5.5.8. For coplanar triangles the polyhedron is flat, and bounded by normals of
// edges in their plane.
#include "query/triangle_sweep.hpp"

#include <algorithm>
#include <cmath>

namespace restage::query {

namespace {

using glm::dvec3;

struct Clip {
    Triangle a, b; // about a corner of b, so that little is lost far away from the origin
    dvec3 by;
    double margin, most;
    TriangleSweep& found;

    // Of an axis of any length. False: they do not meet.
    bool axis(const dvec3& n) const {
        const double length = glm::length(n);
        if (length == 0) return true;
        const double a0 = glm::dot(n, a[0]), a1 = glm::dot(n, a[1]), a2 = glm::dot(n, a[2]);
        const double b1 = glm::dot(n, b[1]), b2 = glm::dot(n, b[2]); // and 0
        const double low = std::min({0.0, b1, b2}) - std::max({a0, a1, a2}) - margin * length;
        const double high = std::max({0.0, b1, b2}) - std::min({a0, a1, a2}) + margin * length;
        const double speed = glm::dot(n, by);
        if (speed == 0) return low <= 0 && high >= 0;
        const double enter = (speed > 0 ? low : high) / speed;
        if (enter > found.enter) {
            found.enter = enter;
            found.normal = n * ((speed > 0 ? -1 : 1) / length);
        }
        found.exit = std::min(found.exit, (speed > 0 ? high : low) / speed);
        return found.enter <= std::min(found.exit, most) && found.exit >= 0;
    }
};

} // namespace

bool sweep(const Triangle& a, const Triangle& b, const dvec3& by, double margin, double most, TriangleSweep& found) {
    found = {};
    const dvec3& o = b[0];
    const Clip clip{{a[0] - o, a[1] - o, a[2] - o}, {dvec3(0), b[1] - o, b[2] - o}, by, margin, most, found};
    const dvec3 along_a[3] = {a[1] - a[0], a[2] - a[1], a[0] - a[2]};
    const dvec3 along_b[3] = {b[1] - b[0], b[2] - b[1], b[0] - b[2]};
    const dvec3 of_a = glm::cross(along_a[0], along_a[1]), of_b = glm::cross(along_b[0], along_b[1]);
    if (!clip.axis(of_b) || !clip.axis(of_a)) return false;
    for (const dvec3& i : along_a)
        for (const dvec3& j : along_b) {
            const dvec3 n = glm::cross(i, j);
            // Of parallel edges only rounding is left.
            if (glm::dot(n, n) > 1e-20 * glm::dot(i, i) * glm::dot(j, j) && !clip.axis(n)) return false;
        }
    const dvec3 turn = glm::cross(of_a, of_b);
    if (glm::dot(turn, turn) > 1e-4 * glm::dot(of_a, of_a) * glm::dot(of_b, of_b)) return true;
    for (int i = 0; i < 3; ++i)
        if (!clip.axis(glm::cross(of_a, along_a[i])) || !clip.axis(glm::cross(of_b, along_b[i]))) return false;
    return true;
}

} // namespace restage::query

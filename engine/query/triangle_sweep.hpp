// SPDX-License-Identifier: Apache-2.0
// A triangle moving in a straight line, without turning, and one at rest.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <limits>

namespace restage::query {

using Triangle = std::array<glm::dvec3, 3>;

struct TriangleSweep {
    // They meet from `enter` to `exit`, in units of the displacement's length; enter < 0: already at the start.
    double enter = -std::numeric_limits<double>::infinity(), exit = std::numeric_limits<double>::infinity();
    glm::dvec3 normal{0}; // of the contact, unit, against the motion
};

// Whether `a`, displaced by t * by, comes as close to `b` as `margin` for some t in [0, most]. Exact, for coplanar
// triangles as well, except that `margin` is exceeded outside of corners and edges. `by` may be 0: then `exit` is
// infinite if they meet.
bool sweep(const Triangle& a, const Triangle& b, const glm::dvec3& by, double margin, double most,
           TriangleSweep& found);

} // namespace restage::query

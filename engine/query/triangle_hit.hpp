// SPDX-License-Identifier: Apache-2.0
// A ray and a triangle.
#pragma once

#include <glm/glm.hpp>

namespace restage::query {

struct TriangleHit {
    double t = -1; // in units of the direction's length; < 0: missed
    double u = 0, v = 0; // weights of b and c
};

// Moeller and Trumbore 1997, double-sided.
inline TriangleHit hit_triangle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& o,
                                const glm::dvec3& d) {
    const glm::dvec3 ab = b - a, ac = c - a, p = glm::cross(d, ac);
    const double det = glm::dot(ab, p);
    if (det == 0) return {};
    const glm::dvec3 s = o - a;
    const double u = glm::dot(s, p) / det;
    if (u < 0 || u > 1) return {};
    const glm::dvec3 q = glm::cross(s, ab);
    const double v = glm::dot(d, q) / det;
    if (v < 0 || u + v > 1) return {};
    return {glm::dot(ac, q) / det, u, v};
}

} // namespace restage::query

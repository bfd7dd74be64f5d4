// SPDX-License-Identifier: Apache-2.0
#include "scene/quadric_hit.hpp"

#include <cmath>
#include <utility>

namespace restage::scene {

namespace {

// For the whole surface. Discriminant as in pbrt 4ed, eq. 6.6, roots by Press et al. 2007, 5.6.
int roots(const Quadric& q, glm::dvec3 o, glm::dvec3 d, double (&t)[2]) {
    if (q.kind == Quadric::Kind::disk) {
        t[0] = (q.z_min - o.z) / d.z;
        return d.z != 0 ? 1 : 0;
    }
    if (q.kind == Quadric::Kind::cylinder) o.z = d.z = 0;
    const double a = glm::dot(d, d), b = glm::dot(o, d);
    if (!(a > 0)) return 0;
    const double l = glm::length(o - b / a * d), discriminant = (q.radius + l) * (q.radius - l);
    if (!(discriminant >= 0)) return 0;
    const double away = glm::length(o), c = (away + q.radius) * (away - q.radius);
    const double root = std::sqrt(a * discriminant), k = b < 0 ? -b + root : -b - root;
    t[0] = k == 0 ? 0 : k / a;
    t[1] = k == 0 ? 0 : c / k;
    if (t[0] > t[1]) std::swap(t[0], t[1]);
    return t[0] == t[1] ? 1 : 2;
}

bool has(const Quadric& q, const glm::dvec3& p) {
    if (q.kind == Quadric::Kind::disk) {
        const double r = std::hypot(p.x, p.y);
        if (r > q.radius || r < q.inner) return false;
    } else {
        const bool sphere = q.kind == Quadric::Kind::sphere; // whole ones have no ends
        if ((!sphere || q.z_min > -q.radius) && p.z < q.z_min) return false;
        if ((!sphere || q.z_max < q.radius) && p.z > q.z_max) return false;
    }
    return q.uv(p).x <= 1;
}

} // namespace

int meet(const Quadric& q, glm::dvec3 o, glm::dvec3 d, double (&t)[2]) {
    double all[2];
    const int n = roots(q, o, d, all);
    int kept = 0;
    for (int i = 0; i < n; ++i)
        if (has(q, o + all[i] * d)) t[kept++] = all[i];
    return kept;
}

} // namespace restage::scene

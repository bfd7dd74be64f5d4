// SPDX-License-Identifier: Apache-2.0
#include "query/aside.hpp"

#include "query/navigation.hpp"

#include <algorithm>
#include <cmath>

namespace restage::query {

double visible_part(const scene::Camera& camera, double aspect, const scene::Bounds& box) {
    glm::dvec2 lower(1e300), upper(-1e300);
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 corner(i & 1 ? box.upper.x : box.lower.x, i & 2 ? box.upper.y : box.lower.y,
                                i & 4 ? box.upper.z : box.lower.z);
        const glm::dvec3 p = project(camera, corner, aspect);
        if (p.z <= 0) return 0;
        lower = glm::min(lower, glm::dvec2(p));
        upper = glm::max(upper, glm::dvec2(p));
    }
    double part = 1;
    for (int i = 0; i < 2; ++i) {
        const double inside = std::min(upper[i], 1.0) - std::max(lower[i], 0.0), all = upper[i] - lower[i];
        part *= all > 0 ? std::clamp(inside / all, 0.0, 1.0) : inside >= 0 ? 1 : 0; // a point has no size
    }
    return part;
}

glm::dvec3 visible_offset(const scene::Camera& camera, double aspect, const glm::dvec3& up, const scene::Bounds& box,
                          double least) {
    const glm::dvec3 right(camera.camera_to_world[0]), toward = -glm::dvec3(camera.camera_to_world[2]);
    // The axis that the picture shows as right, and the one that remains.
    int across = -1, along = -1;
    for (int i = 0; i < 3; ++i) {
        if (std::abs(up[i]) > 0.5) continue;
        (across < 0 ? across : along) = i;
    }
    if (std::abs(right[along]) > std::abs(right[across])) std::swap(across, along);
    const auto offset = [&](int axis, double sign) {
        glm::dvec3 step(0);
        step[axis] = std::copysign(std::max(box.size()[axis] * 1.05, least), sign);
        return step;
    };
    const glm::dvec3 candidates[] = {offset(across, right[across]), offset(across, -right[across]),
                                     offset(along, toward[along]), offset(along, -toward[along])};
    glm::dvec3 best = candidates[0];
    double most = -1;
    for (const glm::dvec3& step : candidates) {
        const double part = visible_part(camera, aspect, {box.lower + step, box.upper + step});
        if (part > most + 1e-9) best = step, most = part;
        if (part >= 1) break;
    }
    return best;
}

} // namespace restage::query

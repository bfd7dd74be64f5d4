// SPDX-License-Identifier: Apache-2.0
// Raycast: ray intersection directly with the scene, in double precision; for picking, dropping and snapping
// objects, not for pictures. Without an acceleration structure over triangles: instance boxes first, then their
// triangles, a few ms for a million of them.
#pragma once

#include "scene/scene.hpp"

#include <functional>
#include <vector>

namespace restage::query {

struct RayHit {
    scene::Id<scene::Instance> instance;
    double t = 0; // in units of the direction's length
    glm::dvec3 position{0};
    glm::dvec3 normal{0}; // geometric, unit, world space, towards the ray's origin
};

// Every instance the ray hits with t > 0, nearest first, each at its first hit. Skips hidden ones and those
// selected by `skip`.
std::vector<RayHit> raycast_all(const scene::Scene&, const glm::dvec3& origin, const glm::dvec3& direction,
                                const std::function<bool(scene::Id<scene::Instance>)>& skip = {});

} // namespace restage::query

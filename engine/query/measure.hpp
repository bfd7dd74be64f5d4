// SPDX-License-Identifier: Apache-2.0
// Points on surfaces under the mouse, for measuring, and the spacing of a grid.
#pragma once

#include "scene/scene.hpp"

#include <functional>
#include <optional>

namespace restage::query {

struct SurfacePoint {
    scene::Id<scene::Instance> instance;
    glm::dvec3 position{0}; // world space
    bool vertex = false; // it is one of the mesh
};

// The surface seen at a point of the film ((0,0) top left, (1,1) bottom right); none: nothing is there. A vertex of
// that object nearer than `snap`, in heights of the film, is returned instead, unless it is behind the surface. Objects
// of `skip` are not seen.
std::optional<SurfacePoint> surface_point(const scene::Scene&, const scene::Camera&, glm::dvec2 film, double aspect,
                                          double snap,
                                          const std::function<bool(scene::Id<scene::Instance>)>& skip = {});

// 1, 2 or 5 times a power of ten: about a twentieth of `extent` (> 0), for the lines of a grid.
double grid_step(double extent);

} // namespace restage::query

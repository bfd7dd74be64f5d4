// SPDX-License-Identifier: Apache-2.0
// Axis-aligned bounds in world space, of an instance and of a scene, from the bounds of the meshes.
#pragma once

#include "scene/scene.hpp"

#include <limits>

namespace restage::scene {

struct Bounds { // empty until something is added
    glm::dvec3 lower{std::numeric_limits<double>::infinity()};
    glm::dvec3 upper{-std::numeric_limits<double>::infinity()};

    bool empty() const { return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z); }
    glm::dvec3 center() const { return 0.5 * (lower + upper); }
    glm::dvec3 size() const { return upper - lower; }
    double radius() const { return empty() ? 0.0 : 0.5 * glm::length(size()); } // of the sphere around the box
    void add(glm::dvec3 point) {
        lower = glm::min(lower, point);
        upper = glm::max(upper, point);
    }
    void add(const Bounds& other) {
        lower = glm::min(lower, other.lower);
        upper = glm::max(upper, other.upper);
    }
};

void compute_bounds(MeshData&); // fills lower and upper from the positions

// The box of the transformed box: encloses the mesh, not always tightly.
Bounds world_bounds(const MeshData&, const glm::dmat4& object_to_world);
Bounds world_bounds(const Scene&, Id<Instance>); // empty for a mesh without data
Bounds world_bounds(const Scene&);               // of all visible instances

} // namespace restage::scene

// SPDX-License-Identifier: Apache-2.0
// Analytic spheres, disks and cylinders. A mesh whose `primitive` is one of them is rendered exactly; its
// triangles represent it where that is not needed: picking, bounds, exports to formats without them. Around z, with
// pbrt's parameters, (u, v) and normals (pbrt-v4 book, ch. 6).
#pragma once

#include "scene/scene.hpp"

namespace restage::scene {

struct Quadric {
    enum class Kind { sphere, disk, cylinder };
    Kind kind = Kind::sphere;
    double radius = 1;
    double z_min = -1, z_max = 1; // equal for a disk: its height
    double inner = 0; // radius of a disk's hole
    double phi_max = 0; // [rad]

    bool whole_sphere() const;
    double area() const;
    glm::dvec3 normal(const glm::dvec3& p) const; // unit, dp/du x dp/dv, at a point on it
    glm::dvec2 uv(const glm::dvec3& p) const;
    glm::dvec3 at(glm::dvec2 uv) const;
};

// The quadric the mesh represents, if any; cones, curves and so on stay triangles.
std::optional<Quadric> quadric_of(const Mesh&);

} // namespace restage::scene

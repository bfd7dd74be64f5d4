// SPDX-License-Identifier: Apache-2.0
// The geometric normal of a hit that Embree found.
#pragma once

#include "render/embree_scene.hpp"
#include "shared/path_data.h"

#include <glm/geometric.hpp>

namespace restage::render {

// Unit, in the kernels' world space; against the ray if the surface has none. `ray.inst` must be an instance.
inline glm::vec3 hit_normal(const GpuScene& scene, const EmbreeScene& embree, const shared::RayHit& ray) {
    glm::vec3 own = ray.ng;
    if (scene.is_quadric(ray.inst)) {
        const scene::Quadric& quadric = *scene.mesh(scene.mesh_of(ray.inst))->quadric;
        own = quadric.normal(quadric.at({ray.u, ray.v}));
    }
    const bool in_world = embree.flat() && !scene.is_quadric(ray.inst);
    const glm::vec3 across = in_world ? own : scene.instances()[ray.inst].normal_to_world * own;
    const float length = glm::length(across);
    return length > 0 ? across / length : -ray.direction;
}

} // namespace restage::render

// SPDX-License-Identifier: Apache-2.0
// CPU intersection of GpuScene's spheres, disks and cylinders; shaders use lib/quadric.glsl.
#include "render/gpu_scene.hpp"

#include "scene/quadric_hit.hpp"

#include <algorithm>
#include <cmath>

namespace restage::render {

using scene::Quadric;

int GpuScene::meet_quadric(std::uint32_t id, const glm::vec3& origin, const glm::vec3& direction, glm::vec2 range,
                           QuadricHit (&hits)[2]) const {
    const shared::InstanceData& in = instances_[id];
    const Quadric& q = *mesh(mesh_of_[id])->quadric;
    const glm::dmat3 inverse = glm::transpose(glm::dmat3(in.normal_to_world));
    const glm::dvec3 o = inverse * (glm::dvec3(origin) - glm::dvec3(in.object_to_world[3]));
    const glm::dvec3 d = inverse * glm::dvec3(direction);
    double t[2];
    const int candidates = scene::meet(q, o, d, t);
    int n = 0;
    for (int i = 0; i < candidates; ++i)
        if (float(t[i]) > range.x && float(t[i]) <= range.y) {
            const glm::dvec3 p = o + t[i] * d;
            const bool leaves = q.kind != Quadric::Kind::disk && glm::dot(d, q.normal(p)) > 0;
            hits[n++] = {float(t[i]), glm::clamp(glm::vec2(q.uv(p)), 0.f, 1.f), leaves ? 1u : 0u};
        }
    return n;
}

glm::mat4x3 GpuScene::placement(std::uint32_t id) const {
    const shared::InstanceData& in = instances_[id];
    if (!is_quadric(id)) return in.object_to_world;
    const Quadric& q = *mesh(mesh_of_[id])->quadric;
    const glm::dmat3 m(in.object_to_world[0], in.object_to_world[1], in.object_to_world[2]);
    const glm::dvec3 centre(0, 0, (q.z_min + q.z_max) / 2), at(in.object_to_world[3]);
    // The margin exceeds the rounding of its position, so that every ray that hits the quadric hits the box.
    const glm::dmat3 back = glm::transpose(glm::dmat3(in.normal_to_world));
    glm::dvec3 away(0);
    for (int i = 0; i < 3; ++i)
        away += glm::abs(back[i] * at[i]);
    glm::dvec3 half = glm::dvec3(q.radius, q.radius, (q.z_max - q.z_min) / 2) +
                      1e-5 * (q.radius + std::max(std::abs(q.z_min), std::abs(q.z_max))) + 2e-6 * away;
    for (int i = 0; i < 3; ++i) // rays are transformed to the box's space, so its inverse must be moderate
        half[i] = std::max(half[i], 1e-9 / glm::length(m[i]));
    const glm::dvec3 place = m * centre + at;
    return {glm::vec3(m[0] * half.x), glm::vec3(m[1] * half.y), glm::vec3(m[2] * half.z), glm::vec3(place)};
}

} // namespace restage::render

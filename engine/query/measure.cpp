// SPDX-License-Identifier: Apache-2.0
#include "query/measure.hpp"

#include "query/navigation.hpp"
#include "query/raycast.hpp"
#include "scene/quadric.hpp"

#include <cmath>

namespace restage::query {

std::optional<SurfacePoint> surface_point(const scene::Scene& scene, const scene::Camera& camera, glm::dvec2 film,
                                          double aspect, double snap,
                                          const std::function<bool(scene::Id<scene::Instance>)>& skip) {
    const ViewRay ray = view_ray(camera, film, aspect);
    const auto hits = raycast_all(scene, ray.origin, ray.direction, skip);
    if (hits.empty()) return std::nullopt;
    SurfacePoint found{hits[0].instance, hits[0].position};
    const scene::Instance& instance = scene.instances[found.instance];
    const scene::Mesh* mesh = scene.meshes.find(instance.mesh);
    if (!(snap > 0) || !mesh || !mesh->data || scene::quadric_of(*mesh)) return found;

    // How large `snap` is at the hit: few vertices are that near, and only these are projected.
    const ViewRay beside = view_ray(camera, film + glm::dvec2(0, snap), aspect);
    const double reach = 2 * glm::length(beside.origin + beside.direction * hits[0].t - hits[0].position);
    double nearest = snap;
    for (const glm::vec3& vertex : mesh->data->positions) {
        const glm::dvec3 world(instance.object_to_world * glm::dvec4(glm::dvec3(vertex), 1));
        const glm::dvec3 away = world - hits[0].position;
        if (!(glm::dot(away, away) <= reach * reach)) continue;
        const glm::dvec3 p = project(camera, world, aspect);
        const double distance = std::hypot((p.x - film.x) * aspect, p.y - film.y);
        if (!(p.z > 0) || distance >= nearest) continue;
        nearest = distance;
        found.position = world;
        found.vertex = true;
    }
    return found;
}

double grid_step(double extent) {
    const double wanted = extent / 20, power = std::pow(10, std::floor(std::log10(wanted)));
    const double digit = wanted / power; // in [1, 10)
    return power * (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10);
}

} // namespace restage::query

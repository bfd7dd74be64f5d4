// SPDX-License-Identifier: Apache-2.0
#include "query/raycast.hpp"

#include "query/triangle_hit.hpp"
#include "scene/bounds.hpp"
#include "scene/quadric_hit.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_inverse.hpp>

namespace restage::query {

namespace {

bool hits_box(const glm::dvec3& lower, const glm::dvec3& upper, const glm::dvec3& o, const glm::dvec3& d) {
    double near = 0, far = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        if (d[i] == 0) {
            if (o[i] < lower[i] || o[i] > upper[i]) return false;
            continue;
        }
        const double a = (lower[i] - o[i]) / d[i], b = (upper[i] - o[i]) / d[i];
        near = std::max(near, std::min(a, b));
        far = std::min(far, std::max(a, b));
    }
    return near <= far;
}

} // namespace

std::vector<RayHit> raycast_all(const scene::Scene& scene, const glm::dvec3& origin, const glm::dvec3& direction,
                                const std::function<bool(scene::Id<scene::Instance>)>& skip) {
    std::vector<RayHit> hits;
    scene.instances.each([&](scene::Id<scene::Instance> id, const scene::Instance& instance) {
        if (instance.hidden || (skip && skip(id))) return;
        const scene::Mesh* mesh = scene.meshes.find(instance.mesh);
        if (!mesh || !mesh->data || mesh->data->triangles.empty()) return;
        // In object space; t stays in world units, as the direction is not normalised.
        const glm::dmat4 to_object = glm::affineInverse(instance.object_to_world);
        const glm::dvec3 o(to_object * glm::dvec4(origin, 1)), d(to_object * glm::dvec4(direction, 0));
        const scene::MeshData& data = *mesh->data;
        const glm::dvec3 lower(data.lower), upper(data.upper);
        const glm::dvec3 slack(1e-6 * glm::length(upper - lower));
        if (!hits_box(lower - slack, upper + slack, o, d)) return;
        double nearest = std::numeric_limits<double>::infinity();
        if (const auto quadric = scene::quadric_of(*mesh)) { // its triangles only approximate it
            double t[2];
            const int n = scene::meet(*quadric, o, d, t);
            for (int i = n; i-- > 0;)
                if (t[i] > 0) nearest = t[i];
            if (!std::isfinite(nearest)) return;
            glm::dvec3 normal = glm::normalize(glm::inverseTranspose(glm::dmat3(instance.object_to_world)) *
                                               quadric->normal(o + nearest * d));
            if (glm::dot(normal, direction) > 0) normal = -normal;
            hits.push_back({id, nearest, origin + nearest * direction, normal});
            return;
        }
        glm::uvec3 which(0);
        for (const glm::uvec3& t : data.triangles) {
            const double hit = hit_triangle(data.positions[t.x], data.positions[t.y], data.positions[t.z], o, d).t;
            if (hit > 0 && hit < nearest) {
                nearest = hit;
                which = t;
            }
        }
        if (!std::isfinite(nearest)) return;
        const auto corner = [&](std::uint32_t i) {
            return glm::dvec3(instance.object_to_world * glm::dvec4(glm::dvec3(data.positions[i]), 1));
        };
        const glm::dvec3 a = corner(which.x);
        glm::dvec3 normal = glm::cross(corner(which.y) - a, corner(which.z) - a);
        const double length = glm::length(normal);
        normal = length > 0 ? normal / length : -glm::normalize(direction);
        if (glm::dot(normal, direction) > 0) normal = -normal;
        hits.push_back({id, nearest, origin + nearest * direction, normal});
    });
    std::sort(hits.begin(), hits.end(), [](const RayHit& a, const RayHit& b) { return a.t < b.t; });
    return hits;
}

} // namespace restage::query

// SPDX-License-Identifier: Apache-2.0
#include "query/surface_site.hpp"

#include "query/triangle_hit.hpp"
#include "scene/quadric_hit.hpp"

#include <cmath>
#include <limits>

namespace restage::query {

namespace {

const scene::Mesh* mesh_of(const scene::Scene& scene, const scene::Instance* instance) {
    const scene::Mesh* mesh = instance ? scene.meshes.find(instance->mesh) : nullptr;
    return mesh && mesh->data ? mesh : nullptr;
}

} // namespace

std::optional<SurfacePlace> place_on(const scene::Scene& scene, scene::Id<scene::Instance> id, const glm::dvec3& origin,
                                     const glm::dvec3& direction) {
    const scene::Instance* instance = scene.instances.find(id);
    const scene::Mesh* mesh = mesh_of(scene, instance);
    if (!mesh) return std::nullopt;
    const glm::dmat4 to_object = glm::inverse(instance->object_to_world);
    const glm::dvec3 o(to_object * glm::dvec4(origin, 1)), d(to_object * glm::dvec4(direction, 0));
    if (const auto quadric = scene::quadric_of(*mesh)) {
        double t[2];
        const int n = scene::meet(*quadric, o, d, t);
        for (int i = 0; i < n; ++i) // nearest first
            if (t[i] > 0) return SurfacePlace{id, 0, quadric->uv(o + t[i] * d)};
        return std::nullopt;
    }
    std::optional<SurfacePlace> found;
    double nearest = std::numeric_limits<double>::infinity();
    const scene::MeshData& data = *mesh->data;
    for (std::size_t i = 0; i < data.triangles.size(); ++i) {
        const glm::uvec3 t = data.triangles[i];
        const TriangleHit hit = hit_triangle(data.positions[t.x], data.positions[t.y], data.positions[t.z], o, d);
        if (!(hit.t > 0) || hit.t >= nearest) continue;
        nearest = hit.t;
        found = SurfacePlace{id, std::uint32_t(i), {hit.u, hit.v}};
    }
    return found;
}

std::optional<SurfaceSite> site_at(const scene::Scene& scene, const SurfacePlace& place, int set) {
    const scene::Instance* instance = scene.instances.find(place.instance);
    const scene::Mesh* mesh = mesh_of(scene, instance);
    if (!mesh) return std::nullopt;
    SurfaceSite site;
    glm::dvec3 du, dv, p; // in object space
    if (const auto quadric = scene::quadric_of(*mesh)) {
        constexpr double h = 1e-5;
        site.uv = place.at;
        p = quadric->at(site.uv);
        const auto difference = [&](const glm::dvec2& by) {
            return (quadric->at(site.uv + by) - quadric->at(site.uv - by)) / (2 * h);
        };
        du = difference({h, 0});
        dv = difference({0, h});
    } else {
        const scene::MeshData& data = *mesh->data;
        if (place.triangle >= data.triangles.size() || data.uvs.empty()) return std::nullopt;
        const glm::uvec3 t = data.triangles[place.triangle];
        const auto& uvs = set == 1 && !data.uvs2.empty() ? data.uvs2 : data.uvs;
        const glm::dvec3 a(data.positions[t.x]), e1 = glm::dvec3(data.positions[t.y]) - a,
                                                 e2 = glm::dvec3(data.positions[t.z]) - a;
        const glm::dvec2 first(uvs[t.x]), d1 = glm::dvec2(uvs[t.y]) - first, d2 = glm::dvec2(uvs[t.z]) - first;
        const double det = d1.x * d2.y - d1.y * d2.x;
        if (std::abs(det) < 1e-14) return std::nullopt;
        p = a + place.at.x * e1 + place.at.y * e2;
        site.uv = first + place.at.x * d1 + place.at.y * d2;
        du = (d2.y * e1 - d1.y * e2) / det;
        dv = (d1.x * e2 - d2.x * e1) / det;
    }
    const glm::dmat4& to_world = instance->object_to_world;
    site.position = glm::dvec3(to_world * glm::dvec4(p, 1));
    site.dpdu = glm::dmat3(to_world) * du;
    site.dpdv = glm::dmat3(to_world) * dv;
    const glm::dvec3 n = glm::cross(site.dpdu, site.dpdv);
    const double length = glm::length(n);
    if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
    site.normal = n / length;
    return site;
}

} // namespace restage::query

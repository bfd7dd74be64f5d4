// SPDX-License-Identifier: Apache-2.0
#include "query/snapping.hpp"

#include "query/measure.hpp"
#include "query/raycast.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace restage::query {

namespace {

constexpr double upright = 0.9; // of a normal along up, of surfaces that things stand on
constexpr double wall_slope = 0.1; // of a wall's normal along up, at most

std::string name_of(const scene::Scene& scene, scene::Id<scene::Instance> id) {
    const scene::Instance* instance = scene.instances.find(id);
    return instance ? instance->name : "";
}

} // namespace

Snapping::Snapping(const scene::Scene& scene, std::span<const std::pair<scene::Id<scene::Instance>, glm::dmat4>> thing,
                   std::unordered_set<scene::Id<scene::Instance>> skip, const glm::dvec3& grabbed, const ViewRay& mouse,
                   const glm::dvec3& up)
    : up_(up), skip_([skip = std::move(skip)](scene::Id<scene::Instance> id) { return skip.contains(id); }) {
    for (const auto& [id, place] : thing) {
        const scene::Instance* instance = scene.instances.find(id);
        const scene::Mesh* mesh = instance ? scene.meshes.find(instance->mesh) : nullptr;
        if (!mesh || !mesh->data) continue;
        for (const glm::vec3& p : mesh->data->positions) {
            points_.emplace_back(place * glm::dvec4(glm::dvec3(p), 1));
            box_.add(points_.back());
        }
    }
    if (box_.empty()) return;
    base_ = box_.center() - up * (0.5 * std::abs(glm::dot(box_.size(), up)));
    corner_ = *std::ranges::min_element(points_, {}, [&](const glm::dvec3& p) { return glm::length(p - grabbed); });
    const double t = glm::dot(base_ - mouse.origin, up) / glm::dot(mouse.direction, up);
    if (std::isfinite(t) && t > 0) below_ = mouse.origin + t * mouse.direction;
}

std::optional<Snapping::Snapped> Snapping::to_vertex(const scene::Scene& scene, const scene::Camera& camera,
                                                     double aspect, const Drag& drag) const {
    const glm::dvec3 film = project(camera, *corner_ + drag.by, aspect);
    if (!(film.z > 0)) return std::nullopt;
    // Around it, too: a corner may be seen against what is behind its object.
    const double r = 0.7 * drag.radius;
    for (const glm::dvec2& by :
         {glm::dvec2(0), glm::dvec2(r / aspect, 0), glm::dvec2(-r / aspect, 0), glm::dvec2(0, r), glm::dvec2(0, -r)}) {
        const auto found = surface_point(scene, camera, glm::dvec2(film) + by, aspect, drag.radius, skip_);
        if (!found || !found->vertex) continue;
        const glm::dvec3 there = project(camera, found->position, aspect);
        if (std::hypot((there.x - film.x) * aspect, there.y - film.y) > drag.radius) continue;
        return Snapped{found->position - *corner_,
                       {{SnapHint::Kind::vertex, found->position, {}, name_of(scene, found->instance)}}};
    }
    return std::nullopt;
}

std::optional<Snapping::Snapped> Snapping::to_surface(const scene::Scene& scene, const Drag& drag) const {
    if (!below_) return std::nullopt;
    const auto hits = raycast_all(scene, drag.mouse.origin, drag.mouse.direction, skip_);
    if (hits.empty() || glm::dot(hits[0].normal, up_) < upright) return std::nullopt;
    const glm::dvec3 by = flat(hits[0].position - *below_) + up_ * glm::dot(hits[0].position - base_, up_);
    // It is still beside the table while the mouse is on it already.
    const double slack = 0.02 * std::max(box_.radius(), 1e-9);
    const glm::dvec3 from = base_ + by + up_ * slack;
    const auto below = raycast_all(scene, from, -up_, skip_);
    if (below.empty() || below[0].t > 2 * slack) return std::nullopt;
    const glm::dvec3 exact = by + up_ * (slack - below[0].t);
    return Snapped{exact, {{SnapHint::Kind::surface, base_ + exact, {}, name_of(scene, below[0].instance)}}};
}

// Rays from its middle along the horizontal axes of the world find walls; it is then moved so that its outermost point
// touches them. A second wall in a corner, too.
void Snapping::to_wall(const scene::Scene& scene, double reach, const std::optional<glm::dvec3>& axis,
                       Snapped& snapped) const {
    struct Wall {
        RayHit hit;
        glm::dvec3 normal;
        double gap;
    };
    std::vector<Wall> walls;
    const auto gap_to = [&](const RayHit& hit, const glm::dvec3& normal) {
        double least = std::numeric_limits<double>::infinity();
        for (const glm::dvec3& p : points_)
            least = std::min(least, glm::dot(p + snapped.by - hit.position, normal));
        return least;
    };
    for (int i = 0; i < 6; ++i) {
        glm::dvec3 direction(0);
        direction[i / 2] = i % 2 ? -1 : 1;
        if (std::abs(glm::dot(direction, up_)) > 0.5) continue;
        if (axis && std::abs(glm::dot(direction, *axis)) < 0.99) continue;
        const auto hits = raycast_all(scene, box_.center() + snapped.by, direction, skip_);
        if (hits.empty() || std::abs(glm::dot(hits[0].normal, up_)) > wall_slope) continue;
        const glm::dvec3 normal = glm::normalize(flat(hits[0].normal));
        if (axis && std::abs(glm::dot(normal, *axis)) < 0.99) continue;
        if (const double gap = gap_to(hits[0], normal); std::abs(gap) <= reach) walls.push_back({hits[0], normal, gap});
    }
    std::ranges::sort(walls, {}, [](const Wall& wall) { return std::abs(wall.gap); });
    std::vector<glm::dvec3> used;
    for (const Wall& wall : walls) {
        if (std::ranges::any_of(used, [&](const glm::dvec3& n) { return std::abs(glm::dot(n, wall.normal)) > 0.3; }))
            continue;
        used.push_back(wall.normal);
        snapped.by -= wall.normal * gap_to(wall.hit, wall.normal);
        const glm::dvec3 base = base_ + snapped.by;
        snapped.hints.push_back({SnapHint::Kind::wall,
                                 base - wall.normal * glm::dot(base - wall.hit.position, wall.normal),
                                 glm::normalize(glm::cross(up_, wall.normal)), name_of(scene, wall.hit.instance)});
        if (used.size() == 2) return;
    }
}

Snapping::Snapped Snapping::snap(const scene::Scene& scene, const scene::Camera& camera, double aspect,
                                 const SnapTo& to, const Drag& drag) const {
    Snapped snapped{drag.by, {}};
    if (box_.empty()) return snapped;
    if (to.vertex && !drag.axis)
        if (auto found = to_vertex(scene, camera, aspect, drag)) return *found;
    if (to.surface && !drag.axis)
        if (auto found = to_surface(scene, drag)) snapped = *found;
    if (to.grid) {
        const glm::dvec3 base = base_ + snapped.by;
        glm::dvec3 by = glm::round(base / drag.grid) * drag.grid - base;
        by = drag.axis ? *drag.axis * glm::dot(by, *drag.axis) : flat(by);
        snapped.by += by;
        snapped.hints.push_back({SnapHint::Kind::grid, base + by, {}, ""});
    }
    if (to.wall) {
        // How large the radius is there.
        const glm::dvec3 film = project(camera, box_.center() + snapped.by, aspect);
        const ViewRay here = view_ray(camera, glm::dvec2(film), aspect),
                      beside = view_ray(camera, glm::dvec2(film) + glm::dvec2(0, drag.radius), aspect);
        const double reach = glm::length(beside.origin - here.origin + (beside.direction - here.direction) * film.z);
        if (film.z > 0) to_wall(scene, reach, drag.axis, snapped);
    }
    return snapped;
}

} // namespace restage::query

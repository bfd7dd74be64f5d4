// SPDX-License-Identifier: Apache-2.0
#include "query/support.hpp"

#include "query/collision.hpp"
#include "scene/bounds.hpp"
#include "scene/quadric_hit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_set>

namespace restage::query {

namespace {

using scene::Bounds;
using InstanceId = scene::Id<scene::Instance>;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int cells = 96; // per side of the raster under the body

// Coordinates with z up. Footprints are in x and y.
struct Frame {
    glm::dmat3 to_local;
    explicit Frame(const glm::dvec3& up) {
        const glm::dvec3 other = std::abs(up.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
        const glm::dvec3 x = glm::normalize(other - up * glm::dot(other, up));
        to_local = glm::transpose(glm::dmat3(x, glm::cross(up, x), up));
    }
    glm::dmat4 of(const scene::Instance& instance) const { return glm::dmat4(to_local) * instance.object_to_world; }
};

Bounds bounds_of(const scene::Scene& s, const Frame& frame, const scene::Instance& instance) {
    const scene::Mesh* mesh = s.meshes.find(instance.mesh);
    return mesh && mesh->data ? scene::world_bounds(*mesh->data, frame.of(instance)) : Bounds{};
}

// Cells over a rectangle, seen from above. A triangle covers the cells whose centre it contains; its corners also cover
// their cells, so that parts thinner than a cell are not missed.
class Raster {
  public:
    Raster(const glm::dvec2& lower, const glm::dvec2& upper) : lower_(lower) {
        step_ = glm::max((upper - lower) / double(cells), glm::dvec2(1e-12));
    }

    // visit(cell, height) for every cell of the mesh: of its triangles, or of the quadric they approximate.
    template <class F>
    void each(const scene::Mesh& mesh, const glm::dmat4& m, F&& visit) const {
        const auto quadric = scene::quadric_of(mesh);
        if (quadric && glm::determinant(m) != 0)
            exact(*quadric, m, visit);
        else
            triangles(*mesh.data, m, visit);
    }

  private:
    // Along a vertical line through the centre of each cell.
    template <class F>
    void exact(const scene::Quadric& quadric, const glm::dmat4& m, F&& visit) const {
        const glm::dmat4 back = glm::inverse(m);
        const glm::dvec3 d(back * glm::dvec4(0, 0, 1, 0));
        for (int cell = 0; cell < cells * cells; ++cell) {
            const glm::dvec2 c = lower_ + (glm::dvec2(cell % cells, cell / cells) + 0.5) * step_;
            double t[2];
            const int n = scene::meet(quadric, glm::dvec3(back * glm::dvec4(c, 0, 1)), d, t);
            for (int i = 0; i < n; ++i)
                visit(cell, t[i]);
        }
    }

    template <class F>
    void triangles(const scene::MeshData& mesh, const glm::dmat4& m, F&& visit) const {
        for (const glm::uvec3& t : mesh.triangles) {
            glm::dvec3 p[3];
            for (int i = 0; i < 3; ++i)
                p[i] = glm::dvec3(m * glm::dvec4(glm::dvec3(mesh.positions[t[i]]), 1));
            for (const glm::dvec3& corner : p) {
                const glm::ivec2 c(glm::floor((glm::dvec2(corner) - lower_) / step_));
                if (c.x >= 0 && c.y >= 0 && c.x < cells && c.y < cells) visit(c.y * cells + c.x, corner.z);
            }
            triangle(p, visit);
        }
    }

    template <class F>
    void triangle(const glm::dvec3 (&p)[3], F&& visit) const {
        const glm::dvec2 lo = glm::min(glm::min(glm::dvec2(p[0]), glm::dvec2(p[1])), glm::dvec2(p[2]));
        const glm::dvec2 hi = glm::max(glm::max(glm::dvec2(p[0]), glm::dvec2(p[1])), glm::dvec2(p[2]));
        const auto first = glm::clamp(glm::ceil((lo - lower_) / step_ - 0.5), 0.0, double(cells));
        const auto last = glm::clamp(glm::floor((hi - lower_) / step_ - 0.5), -1.0, double(cells - 1));
        const glm::dvec2 a(p[1] - p[0]), b(p[2] - p[0]);
        const double area = a.x * b.y - a.y * b.x;
        if (area == 0) return; // edge-on: its corners are already covered
        for (int y = int(first.y); y <= int(last.y); ++y)
            for (int x = int(first.x); x <= int(last.x); ++x) {
                const glm::dvec2 c = lower_ + (glm::dvec2(x, y) + 0.5) * step_ - glm::dvec2(p[0]);
                const double u = (c.x * b.y - c.y * b.x) / area, v = (a.x * c.y - a.y * c.x) / area;
                if (u >= 0 && v >= 0 && u + v <= 1)
                    visit(y * cells + x, p[0].z + u * (p[1].z - p[0].z) + v * (p[2].z - p[0].z));
            }
    }

    glm::dvec2 lower_, step_;
};

bool overlap(const Bounds& a, const Bounds& b) { // of footprints
    return !a.empty() && !b.empty() && a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y &&
           b.lower.y <= a.upper.y;
}

// Infinite if nothing is below. By a raster, about which quadrics are exact, though triangles only approximate them.
double raster_fall(const scene::Scene& s, std::span<const InstanceId> ids, const std::unordered_set<InstanceId>& skip,
                   const glm::dvec3& up) {
    const Frame frame(up);
    Bounds all;
    for (const InstanceId id : ids)
        if (const scene::Instance* instance = s.instances.find(id)) all.add(bounds_of(s, frame, *instance));
    if (all.empty()) return infinity;

    // Its underside and top, cell by cell.
    const Raster raster{glm::dvec2(all.lower), glm::dvec2(all.upper)};
    std::vector<double> under(cells * cells, infinity), top(cells * cells, -infinity);
    for (const InstanceId id : ids)
        if (const scene::Instance* instance = s.instances.find(id))
            if (const scene::Mesh* mesh = s.meshes.find(instance->mesh); mesh && mesh->data)
                raster.each(*mesh, frame.of(*instance), [&](int cell, double z) {
                    under[std::size_t(cell)] = std::min(under[std::size_t(cell)], z);
                    top[std::size_t(cell)] = std::max(top[std::size_t(cell)], z);
                });
    // It is sunk into surfaces a little above its underside; those at its top stand on it.
    const double sunk = 0.1 * (all.upper.z - all.lower.z);
    std::vector<double> reach(under.size());
    for (std::size_t i = 0; i < reach.size(); ++i)
        reach[i] = under[i] + std::min(sunk, 0.5 * (top[i] - under[i]));

    double least = infinity;
    s.instances.each([&](InstanceId id, const scene::Instance& instance) {
        if (instance.hidden || skip.contains(id)) return;
        const Bounds box = bounds_of(s, frame, instance);
        if (!overlap(box, all) || box.lower.z > all.upper.z) return;
        if (all.lower.z - box.upper.z > least) return; // something nearer was found
        raster.each(s.meshes[instance.mesh], frame.of(instance), [&](int cell, double z) {
            const auto i = std::size_t(cell);
            if (under[i] < infinity && z <= reach[i]) least = std::min(least, under[i] - z);
        });
    });
    return least;
}

bool is_quadric(const scene::Scene& s, const scene::Instance& instance) {
    const scene::Mesh* mesh = s.meshes.find(instance.mesh);
    return mesh && scene::quadric_of(*mesh);
}

} // namespace

std::optional<double> fall_distance(const scene::Scene& s, std::span<const InstanceId> ids, const glm::dvec3& up) {
    std::unordered_set<InstanceId> round(ids.begin(), ids.end()), flat = round; // what each method leaves out
    const bool round_body = std::ranges::any_of(ids, [&](InstanceId id) {
        const scene::Instance* instance = s.instances.find(id);
        return instance && is_quadric(s, *instance);
    });
    bool any_round = round_body;
    s.instances.each([&](InstanceId id, const scene::Instance& instance) {
        const bool quadric = round_body || is_quadric(s, instance);
        (quadric ? round : flat).insert(id);
        any_round |= quadric;
    });
    double least = infinity;
    if (!round_body) least = Collision(s, Collision::thing_of(s, ids), round, up).fall().value_or(infinity);
    if (any_round) least = std::min(least, raster_fall(s, ids, flat, up));
    return std::isfinite(least) ? std::optional(least) : std::nullopt;
}

} // namespace restage::query

// SPDX-License-Identifier: Apache-2.0
#include "query/collision.hpp"

#include "query/triangle_tree.hpp"
#include "scene/bounds.hpp"

#include <algorithm>
#include <cmath>

namespace restage::query {

namespace {

using glm::dvec3;
using scene::Bounds;
using InstanceId = scene::Id<scene::Instance>;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double gap = 1e-7; // kept from what is met [size of the thing]
constexpr double deepest = 0.1; // contact at the start that is resolved [size of the thing]
constexpr std::size_t most_pairs = 8192; // of triangles, of such contact with one object
constexpr int slides = 3; // along one thing after the other
constexpr double steep = 0.7; // of a normal along up: less is a wall

struct Obstacle {
    InstanceId id;
    Bounds box;
    std::shared_ptr<const scene::MeshData> mesh;
    glm::dmat4 place;
    // The thing counts as displaced by this, too, so that it does not touch this one at the start; or it is too deep in
    // it.
    dvec3 apart{0};
    bool ignored = false;
    std::unique_ptr<const TriangleTree> made;

    const TriangleTree& tree() {
        if (!made) made = std::make_unique<TriangleTree>(mesh, place);
        return *made;
    }
};

// The part of `wanted` along the planes, none of which it may enter: along one of them, if that enters no other, else
// along the edge of two. As in Quake's player movement (id Software 1996, pmove.c).
dvec3 along_planes(const dvec3& wanted, const std::vector<dvec3>& planes) {
    const auto enters_none = [&](const dvec3& v) {
        return std::ranges::all_of(planes,
                                   [&](const dvec3& n) { return glm::dot(v, n) > -1e-5 * glm::length(wanted); });
    };
    for (std::size_t i = planes.size(); i-- > 0;)
        if (const dvec3 v = wanted - planes[i] * glm::dot(planes[i], wanted); enters_none(v)) return v;
    for (std::size_t i = 0; i < planes.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            const dvec3 edge = glm::cross(planes[i], planes[j]);
            if (glm::length(edge) < 1e-4) continue;
            const dvec3 v = edge * (glm::dot(edge, wanted) / glm::dot(edge, edge));
            if (enters_none(v)) return v;
        }
    return dvec3(0);
}

} // namespace

struct Collision::Impl {
    std::vector<TriangleTree> thing;
    std::vector<Obstacle> obstacles;
    Bounds box; // of the thing, at the start
    double size = 0;
    dvec3 up, now{0};

    struct Hit {
        double t = 1; // of the displacement
        dvec3 normal{0};
        InstanceId id;
    };

    // visit(obstacle, a, b) for pairs of triangles that may come as close as `margin` during a displacement from
    // `from` (by at most * by), with the nearest obstacle first.
    template <class F>
    void each_pair(const dvec3& from, const dvec3& by, double margin, const double& most, F&& visit) {
        std::vector<std::pair<double, Obstacle*>> near;
        for (Obstacle& one : obstacles) {
            if (one.ignored) continue;
            if (const double enter = entry(one, from, by, margin); enter <= most) near.emplace_back(enter, &one);
        }
        std::ranges::sort(near);
        for (const auto& [enter, one] : near)
            for (const TriangleTree& part : thing) {
                if (enter > most) return;
                TriangleTree::each_pair(part, from + one->apart, by, one->tree(), margin, most,
                                        [&](const Triangle& a, const Triangle& b) { visit(*one, a, b); });
            }
    }

    double entry(const Obstacle& one, const dvec3& displaced, const dvec3& by, double margin) const {
        const dvec3 from = displaced + one.apart;
        return box_entry(one.box.lower - box.upper - from - margin, one.box.upper - box.lower - from + margin, by, 1);
    }

    // The first contact. Triangles that overlap at the start do not count.
    std::optional<Hit> first_hit(const dvec3& from, const dvec3& by) {
        const double tie = 1e-3 * gap * size / glm::length(by);
        double most = 1;
        std::optional<Hit> hit;
        each_pair(from, by, 0, most, [&](const Obstacle& one, const Triangle& a, const Triangle& b) {
            TriangleSweep met;
            if (!sweep(a, b, by, 0, most, met) || met.enter < 0) return;
            // Of contacts at one time the one that stops it most: not the edge between two triangles of a wall.
            if (hit && met.enter >= hit->t - tie && glm::dot(met.normal, by) >= glm::dot(hit->normal, by)) return;
            hit = {met.enter, met.normal, one.id};
            most = std::min(1.0, met.enter + tie);
        });
        return hit;
    }

    bool overlaps(const dvec3& from, double margin) {
        double most = 0;
        each_pair(from, dvec3(0), margin, most, [&](const Obstacle&, const Triangle& a, const Triangle& b) {
            TriangleSweep met;
            if (sweep(a, b, dvec3(0), margin, 0, met)) most = -1;
        });
        return most < 0;
    }

    // Finds `apart`, in some rounds: each ends all overlaps of pairs of triangles, by their shortest ways along six
    // directions, of equal ones the first; they may be in others then.
    void come_apart(Obstacle& one) {
        constexpr int rounds = 10;
        const double margin = 0.5 * gap * size, limit = deepest * size;
        const dvec3 other = std::abs(up.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
        const dvec3 x = glm::normalize(other - up * glm::dot(other, up)), y = glm::cross(up, x);
        const dvec3 ways[6] = {up, x, -x, y, -y, -up};
        one.ignored = false;
        one.apart = dvec3(0);
        for (int round = 0; round < rounds && glm::length(one.apart) <= limit; ++round) {
            if (entry(one, now, dvec3(0), margin) > 0) return;
            double out[6] = {}, most = 0;
            std::size_t pairs = 0;
            for (const TriangleTree& part : thing) {
                if (most < 0) break;
                TriangleTree::each_pair(
                    part, now + one.apart, dvec3(0), one.tree(), margin, most,
                    [&](const Triangle& a, const Triangle& b) {
                        TriangleSweep found;
                        if (most < 0 || !sweep(a, b, dvec3(0), margin, 0, found)) return;
                        int best = 0;
                        double least = infinity;
                        for (int i = 0; i < 6; ++i)
                            if (sweep(a, b, ways[i], margin, infinity, found) && found.exit < least - margin) {
                                best = i;
                                least = found.exit;
                            }
                        out[best] = std::max(out[best], least);
                        if (least > limit || ++pairs > most_pairs) most = -1;
                    });
            }
            if (most < 0) break;
            if (pairs == 0) return;
            dvec3 push(0);
            for (int i = 0; i < 6;
                 ++i) // of opposite ones the second: faces that coincide may go either way, and took the first
                if (out[i] > 0) push += ways[i] * std::max(0.0, out[i] + 2 * margin - glm::dot(push, ways[i]));
            one.apart += push;
        }
        one.ignored = true;
        one.apart = dvec3(0);
    }

    void come_apart() {
        for (Obstacle& one : obstacles)
            come_apart(one);
    }

    // What it was entangled with counts again.
    void forget_left() {
        for (Obstacle& one : obstacles) {
            if (!one.ignored) continue;
            double most = entry(one, now, dvec3(0), 0) > 0 ? 1 : 0;
            for (const TriangleTree& part : thing)
                if (most == 0)
                    TriangleTree::each_pair(part, now, dvec3(0), one.tree(), 0, most,
                                            [&](const Triangle& a, const Triangle& b) {
                                                TriangleSweep found;
                                                if (sweep(a, b, dvec3(0), 0, 0, found)) most = -1;
                                            });
            one.ignored = most < 0;
        }
    }

    // Collide and slide (Fauerby, Improved Collision Detection and Response, 2003): to the first contact, then with the
    // rest of the way along its plane.
    std::vector<InstanceId> move(const dvec3& to, int contacts) {
        std::vector<InstanceId> met;
        if (obstacles.empty()) {
            now = to;
            return met;
        }
        const double skin = gap * size;
        std::vector<dvec3> planes;
        for (int i = 0; i <= contacts; ++i) {
            dvec3 by = to - now;
            if (!planes.empty()) {
                by = along_planes(by, planes);
                // Away from the plane a little, which rounding would enter on a long way.
                if (glm::length(by) > skin) by += planes.back() * skin;
            }
            if (!(glm::length(by) > 1e-3 * skin)) break;
            const auto hit = first_hit(now, by);
            if (!hit) {
                now = planes.empty() ? to : now + by;
                break;
            }
            now += by * std::max(0.0, hit->t - skin / std::max(-glm::dot(by, hit->normal), 1e-300));
            const double slope = glm::dot(hit->normal, up);
            planes.push_back(std::abs(slope) < steep ? glm::normalize(hit->normal - up * slope) : hit->normal);
            if (std::ranges::find(met, hit->id) == met.end()) met.push_back(hit->id);
        }
        forget_left();
        return met;
    }
};

Collision::Thing Collision::thing_of(const scene::Scene& scene,
                                     std::span<const std::pair<InstanceId, glm::dmat4>> places) {
    Thing thing;
    for (const auto& [id, place] : places) {
        const scene::Instance* instance = scene.instances.find(id);
        const scene::Mesh* mesh = instance ? scene.meshes.find(instance->mesh) : nullptr;
        if (mesh && mesh->data) thing.push_back({mesh->data, place});
    }
    return thing;
}

Collision::Thing Collision::thing_of(const scene::Scene& scene, std::span<const InstanceId> ids) {
    std::vector<std::pair<InstanceId, glm::dmat4>> places;
    for (const InstanceId id : ids)
        if (const scene::Instance* instance = scene.instances.find(id))
            places.emplace_back(id, instance->object_to_world);
    return thing_of(scene, places);
}

Collision::Collision(const scene::Scene& scene, const Thing& thing, const std::unordered_set<InstanceId>& skip,
                     const dvec3& up)
    : impl_(std::make_unique<Impl>()) {
    Impl& in = *impl_;
    in.up = up;
    for (const Part& part : thing) {
        in.thing.emplace_back(part.mesh, part.place);
        if (const auto& nodes = in.thing.back().nodes(); !nodes.empty())
            in.box.add(Bounds{dvec3(nodes[0].lower), dvec3(nodes[0].upper)});
    }
    if (in.box.empty()) return;
    in.size = glm::length(in.box.size());
    scene.instances.each([&](InstanceId id, const scene::Instance& instance) {
        const scene::Mesh* mesh = scene.meshes.find(instance.mesh);
        if (instance.hidden || skip.contains(id) || !mesh || !mesh->data || mesh->data->triangles.empty()) return;
        const Bounds box = scene::world_bounds(*mesh->data, instance.object_to_world);
        if (!box.empty())
            in.obstacles.push_back({.id = id,
                                    .box = box,
                                    .mesh = mesh->data,
                                    .place = instance.object_to_world,
                                    .apart = dvec3(0),
                                    .ignored = false,
                                    .made = nullptr});
    });
    in.come_apart();
}

Collision::~Collision() = default;

const dvec3& Collision::at() const { return impl_->now; }

std::vector<InstanceId> Collision::stop(const dvec3& to) { return impl_->move(to, 0); }

std::vector<InstanceId> Collision::slide(const dvec3& to) { return impl_->move(to, slides); }

bool Collision::place(const dvec3& to) {
    Impl& in = *impl_;
    // Things that touch may overlap by rounding.
    for (const dvec3& place : {to, to + in.up * (2 * gap * in.size)})
        if (!in.overlaps(place, 0.25 * gap * in.size)) {
            in.now = place;
            in.forget_left();
            return true;
        }
    return false;
}

void Collision::force(const dvec3& to) {
    impl_->now = to;
    impl_->come_apart();
}

dvec3 Collision::make_room(const dvec3& viewer) {
    Impl& in = *impl_;
    if (std::ranges::none_of(in.obstacles, &Obstacle::ignored)) return in.now;
    for (Obstacle& one : in.obstacles)
        one.ignored = false;
    const dvec3 wanted = in.now, way = viewer - (in.box.center() + wanted);
    for (double part = 1.0 / 32; part < 1; part += 1.0 / 32)
        if (place(wanted + way * part)) {
            constexpr int tries = 8;
            for (int i = 0; i < tries; ++i)
                slide(wanted);
            return in.now;
        }
    force(wanted);
    return wanted;
}

std::optional<double> Collision::fall() const {
    Impl& in = *impl_;
    double lowest = infinity; // along up
    for (const Obstacle& one : in.obstacles)
        lowest = std::min(lowest, glm::dot(one.box.center(), in.up) - 0.5 * glm::dot(one.box.size(), glm::abs(in.up)));
    const double top = glm::dot(in.box.center() + in.now, in.up) + 0.5 * glm::dot(in.box.size(), glm::abs(in.up));
    const double way = (top - lowest) * (1 + 1e-6);
    if (!std::isfinite(way) || !(way > 0)) return std::nullopt;
    const double limit = deepest * in.size; // of what it is sunk into others
    double least = infinity, most = 1;
    in.each_pair(in.now, -in.up * way, 0, most, [&](const Obstacle& one, const Triangle& a, const Triangle& b) {
        TriangleSweep met;
        if (!sweep(a, b, -in.up * way, 0, most, met) || met.enter < 0) return;
        least = std::min(least, met.enter * way - glm::dot(one.apart, in.up));
        most = std::min(1.0, (least + 2 * limit) / way);
    });
    return std::isfinite(least) ? std::optional(least) : std::nullopt;
}

} // namespace restage::query

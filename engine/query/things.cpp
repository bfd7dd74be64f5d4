// SPDX-License-Identifier: Apache-2.0
#include "query/things.hpp"

#include "query/contact.hpp"
#include "query/thing_parts.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace restage::query {

namespace {

using glm::dvec3;
using scene::Bounds;
using GroupId = scene::Id<scene::Group>;
using InstanceId = scene::Id<scene::Instance>;

// Tuned on rooms of 20 to 300 objects that nobody named or grouped.
constexpr double gap = 0.02;              // surfaces this close touch, relative to the smaller box's diagonal,
constexpr double least_gap = 0.0005;      // but at least this and at most that, relative to the scene's
constexpr double most_gap = 0.002;
constexpr double far_gap = 5;             // times that, for what would float otherwise
constexpr double slab = 0.08;             // thickness of walls and floors, relative to their diagonal
constexpr double large = 0.35;            // their diagonal, relative to the scene's
constexpr double whole_scene = 0.6;       // a thing this large, relative to the scene, is a mistake
constexpr double group_gap = 0.03;        // between parts of one group, relative to its diagonal

class Finder {
  public:
    Finder(const scene::Scene& scene, const dvec3& up, std::uint32_t imported_groups, const std::function<bool()>& stop)
        : scene_(scene), contacts_(scene), imported_groups_(imported_groups), stop_(stop) {
        const dvec3 other = std::abs(up.x) < 0.6 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
        const dvec3 x = glm::normalize(other - up * glm::dot(other, up));
        to_frame_ = glm::transpose(glm::dmat3(x, glm::cross(up, x), up));
    }

    Things find() {
        Things things;
        things.imported_groups = imported_groups_;
        gather();
        if (!too_large()) find_architecture();
        find_collections(things.collections);
        make_units(things.collections);
        things.of.resize(scene_.instances.size() + 1, 0);
        if (too_large() || units_.size() < 2 || stopped()) return things;
        find_contacts();
        if (stopped()) return things;
        joined_.emplace(join_units(units_, touching_));
        if (has_floor_) join_floating();
        std::map<std::uint32_t, std::vector<std::uint32_t>> found;
        for (std::uint32_t u = 0; u < units_.size(); ++u)
            if (!units_[u].architecture && !units_[u].own) found[joined_->root(u)].push_back(u);
        for (const auto& [root, units] : found) {
            Bounds box;
            for (const std::uint32_t u : units)
                box.add(units_[u].box);
            if (units.size() < 2 || (has_floor_ && diagonal(box) > whole_scene * size_)) continue;
            const auto number = std::uint32_t(things.members.size());
            auto& members = things.members.emplace_back();
            for (const std::uint32_t u : units)
                for (const std::uint32_t p : units_[u].parts) {
                    things.of[parts_[p].id.value] = number;
                    members.push_back(parts_[p].id);
                }
            std::sort(members.begin(), members.end());
        }
        return things;
    }

  private:
    struct Part {
        InstanceId id;
        Bounds box; // z up, as all that follows
        bool architecture = false;
        std::uint32_t unit = 0;
    };
    bool too_large() const { return parts_.size() > most_objects || triangles_ > most_triangles; }
    bool stopped() const { return stop_ && stop_(); }
    dvec3 in_frame(const dvec3& p) const { return to_frame_ * p; }

    void gather() {
        const glm::dmat4 turn(to_frame_);
        std::set<scene::Id<scene::Mesh>> meshes;
        scene_.instances.each([&](InstanceId id, const scene::Instance& instance) {
            const scene::Mesh* mesh = scene_.meshes.find(instance.mesh);
            if (!mesh || !mesh->data || mesh->data->triangles.empty()) return;
            Part part{.id = id, .box = scene::world_bounds(*mesh->data, turn * instance.object_to_world)};
            if (part.box.empty()) return;
            all_.add(part.box);
            if (meshes.insert(instance.mesh).second) triangles_ += mesh->data->triangles.size();
            parts_.push_back(part);
        });
        size_ = diagonal(all_);
    }

    // Large flat objects with nearly everything on one side, and what the camera is inside of.
    void find_architecture() {
        const scene::Camera* camera = scene_.cameras.find(scene_.active_camera.value);
        std::vector<Part*> sides;
        for (Part& part : parts_) {
            if (diagonal(part.box) < large * size_) continue;
            if (camera && part.box.size().z > 0 && holds(part.box, in_frame(dvec3(camera->camera_to_world[3])))) {
                part.architecture = has_floor_ = true;
                continue;
            }
            const auto normal = flat(part);
            if (!normal) continue;
            const dvec3 center = part.box.center();
            std::size_t above = 0, below = 0;
            for (const Part& other : parts_) {
                if (&other == &part) continue;
                (glm::dot(other.box.center() - center, *normal) > 0 ? above : below) += 1;
            }
            const auto share = [&](std::size_t n) {
                return double(n) / double(std::max<std::size_t>(above + below, 1));
            };
            if (normal->z > 0.9 && share(above) > 0.95)
                part.architecture = has_floor_ = true;
            else if (std::max(share(above), share(below)) > 0.8)
                sides.push_back(&part);
        }
        if (has_floor_) // else a table's top would be a ceiling
            for (Part* part : sides)
                part->architecture = true;
    }

    // The normal of a flat object, with z >= 0.
    std::optional<dvec3> flat(const Part& part) {
        const std::vector<dvec3>& points = contacts_.points(part.id);
        if (points.empty()) return std::nullopt;
        // The direction of least variance: inverse iteration on the covariance.
        dvec3 mean(0);
        for (const dvec3& p : points)
            mean += in_frame(p) / double(points.size());
        glm::dmat3 covariance(0);
        for (const dvec3& p : points) {
            const dvec3 d = in_frame(p) - mean;
            covariance += glm::outerProduct(d, d) / double(points.size());
        }
        const double trace = covariance[0][0] + covariance[1][1] + covariance[2][2];
        const glm::dmat3 inverse = glm::inverse(covariance + glm::dmat3(1e-9 * trace + 1e-300));
        dvec3 n(0.31, 0.42, 0.85);
        for (int i = 0; i < 40; ++i)
            n = glm::normalize(inverse * n);
        double low = 1e300, high = -1e300;
        for (const dvec3& p : points) {
            const double h = glm::dot(in_frame(p) - mean, n);
            low = std::min(low, h), high = std::max(high, h);
        }
        if (!(high - low <= slab * diagonal(part.box))) return std::nullopt;
        return n.z < 0 ? -n : n;
    }

    // A group gathers separate things if it contains a floor or a wall, or parts far from each other. Groups that
    // the user made do not.
    void find_collections(std::vector<bool>& collections) {
        collections.assign(scene_.groups.size() + 1, false);
        std::map<std::uint32_t, std::vector<std::uint32_t>> parts; // of each group, at any depth
        for (std::uint32_t p = 0; p < parts_.size(); ++p)
            each_group(parts_[p].id, [&](GroupId group) { parts[group.value].push_back(p); });
        for (const auto& [value, members] : parts) {
            if (value > imported_groups_) continue;
            bool apart = members.size() > most_objects;
            Bounds all;
            for (const std::uint32_t p : members) {
                all.add(parts_[p].box);
                apart = apart || (members.size() > 1 && parts_[p].architecture);
            }
            if (!apart && members.size() > 1) {
                std::vector<Bounds> boxes;
                for (const std::uint32_t p : members)
                    boxes.push_back(grown(parts_[p].box, 0.5 * group_gap * diagonal(all)));
                Union near(boxes.size());
                each_overlap(boxes, [&](std::uint32_t a, std::uint32_t b) { near.join(a, b); });
                for (std::uint32_t i = 0; i < boxes.size(); ++i)
                    apart = apart || near.root(i) != 0;
            }
            collections[value] = apart;
        }
    }

    template <class F>
    void each_group(InstanceId id, F&& f) const { // from the inside out
        GroupId group = scene_.instances[id].group;
        for (std::size_t depth = 0; scene_.groups.find(group) && depth <= scene_.groups.size(); ++depth) {
            f(group);
            group = scene_.groups[group].parent;
        }
    }

    void make_units(const std::vector<bool>& collections) {
        std::map<std::uint32_t, std::uint32_t> of_group;
        for (std::uint32_t p = 0; p < parts_.size(); ++p) {
            GroupId outermost;
            each_group(parts_[p].id, [&](GroupId group) {
                if (!collections[group.value]) outermost = group;
            });
            std::uint32_t u = std::uint32_t(units_.size());
            if (outermost) u = of_group.try_emplace(outermost.value, u).first->second;
            if (u == units_.size()) units_.emplace_back();
            Unit& unit = units_[u];
            unit.parts.push_back(p);
            unit.box.add(parts_[p].box);
            unit.own = outermost.value > imported_groups_;
            unit.architecture = unit.architecture || parts_[p].architecture;
            unit.mesh = unit.parts.size() == 1 ? scene_.instances[parts_[p].id].mesh : scene::Id<scene::Mesh>{};
            parts_[p].unit = u;
        }
    }

    void measure(Unit& unit) {
        const std::size_t most = 3000, parts = unit.parts.size(); // points of an outline
        for (const std::uint32_t p : unit.parts) {
            const std::vector<dvec3>& points = contacts_.points(parts_[p].id);
            unit.points += points.size();
            for (std::size_t i = 0; i < points.size(); i += std::max<std::size_t>(1, points.size() * parts / most))
                unit.outline.emplace_back(in_frame(points[i]));
        }
        unit.footprint = Rectangle::smallest(unit.outline);
    }

    void find_contacts() {
        std::vector<Bounds> boxes;
        for (const Part& part : parts_)
            boxes.push_back(grown(part.box, gap_of(units_[part.unit]) * 0.5));
        each_overlap(boxes, [&](std::uint32_t a, std::uint32_t b) {
            const std::uint32_t u = parts_[a].unit, v = parts_[b].unit;
            if (u == v || (units_[u].architecture && units_[v].architecture) || stopped()) return;
            Contact& contact = touching_[{std::min(u, v), std::max(u, v)}];
            contact.gap = std::min(gap_of(units_[u]), gap_of(units_[v]));
            add_points(u < v ? contact.on_a : contact.on_b, parts_[a], parts_[b], contact.gap);
            add_points(u < v ? contact.on_b : contact.on_a, parts_[b], parts_[a], contact.gap);
        });
        std::erase_if(touching_,
                      [](const auto& entry) { return entry.second.on_a.empty() && entry.second.on_b.empty(); });
        for (Unit& unit : units_)
            measure(unit);
    }
    double gap_of(const Unit& unit) const {
        return std::clamp(gap * diagonal(unit.box), least_gap * size_, most_gap * size_);
    }
    void add_points(std::vector<dvec3>& points, const Part& from, const Part& to, double radius) {
        const Bounds box = grown(to.box, radius);
        for (const dvec3& p : contacts_.points(from.id))
            if (const dvec3 q = in_frame(p); holds(box, q) && contacts_.near(to.id, p, radius)) points.push_back(q);
    }

    // What floats in the air belongs to what it is closest to: modelled with a gap.
    void join_floating() {
        std::vector<Bounds> boxes;
        for (const Part& part : parts_)
            boxes.push_back(grown(part.box, 0.5 * far_gap * gap_of(units_[part.unit])));
        std::map<std::uint32_t, std::pair<std::size_t, std::uint32_t>> closest; // floating root -> points, unit
        each_overlap(boxes, [&](std::uint32_t p, std::uint32_t q) {
            std::uint32_t u = parts_[p].unit, v = parts_[q].unit;
            if (units_[u].anchored == units_[v].anchored || units_[u].own || units_[v].own || stopped()) return;
            if (units_[u].anchored) std::swap(u, v), std::swap(p, q);
            if (units_[v].architecture || touching_.contains({std::min(u, v), std::max(u, v)}))
                return; // the latter rests
            std::vector<dvec3> points;
            const double reach = far_gap * std::min(gap_of(units_[u]), gap_of(units_[v]));
            add_points(points, parts_[p], parts_[q], reach);
            add_points(points, parts_[q], parts_[p], reach);
            auto& best = closest[joined_->root(u)];
            if (points.size() > best.first) best = {points.size(), v};
        });
        for (const auto& [root, to] : closest)
            if (to.first > 0) joined_->join(root, to.second);
    }
    const scene::Scene& scene_;
    Contacts contacts_;
    std::uint32_t imported_groups_;
    const std::function<bool()>& stop_;
    glm::dmat3 to_frame_{1};
    std::vector<Part> parts_;
    std::vector<Unit> units_;
    std::map<Pair, Contact> touching_;
    std::optional<Union> joined_;                                        // units
    Bounds all_;
    double size_ = 0;
    std::size_t triangles_ = 0;
    bool has_floor_ = false;
};

} // namespace

Things find_things(const scene::Scene& scene, const dvec3& up, std::uint32_t imported_groups,
                   const std::function<bool()>& stop) {
    return Finder(scene, up, imported_groups, stop).find();
}

void Things::add(const Things& more) {
    const std::size_t known = of.size();
    of.resize(std::max(of.size(), more.of.size()), 0);
    for (std::size_t number = 1; number < more.members.size(); ++number) {
        const auto& ids = more.members[number];
        if (std::any_of(ids.begin(), ids.end(), [&](InstanceId id) { return id.value < known; })) continue;
        for (const InstanceId id : ids)
            of[id.value] = std::uint32_t(members.size());
        members.push_back(ids);
    }
}

void Things::copied(std::span<const InstanceId> originals, std::span<const InstanceId> copies) {
    for (const InstanceId id : copies) {
        of.resize(std::max<std::size_t>(of.size(), id.value + 1), 0);
        of[id.value] = 0;
    }
    std::map<std::pair<std::size_t, std::uint32_t>, std::vector<InstanceId>> made; // by set and thing
    for (std::size_t i = 0; i < copies.size() && !originals.empty(); ++i)
        if (const std::uint32_t thing = number(originals[i % originals.size()]))
            made[{i / originals.size(), thing}].push_back(copies[i]);
    for (auto& [key, ids] : made) {
        if (ids.size() < members[key.second].size()) continue;
        for (const InstanceId id : ids)
            of[id.value] = std::uint32_t(members.size());
        members.push_back(std::move(ids));
    }
}

} // namespace restage::query

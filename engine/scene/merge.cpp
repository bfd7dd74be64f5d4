// SPDX-License-Identifier: Apache-2.0
#include "scene/merge.hpp"

#include "scene/edits.hpp"
#include "scene/links.hpp"
#include "scene/share_materials.hpp"
#include "scene/tables.hpp"
#include "scene/uses.hpp"

#include <cmath>
#include <set>
#include <tuple>
#include <unordered_map>

namespace restage::scene {

namespace {

const Camera* active_camera(const Scene& scene) { return scene.cameras.find(scene.active_camera.value); }

// The axis nearest to the camera's up, with its sign.
glm::dvec3 up_axis(const Camera& camera) {
    const glm::dvec3 up = glm::dvec3(camera.camera_to_world[1]), size = glm::abs(up);
    const int axis = size.y >= size.x && size.y >= size.z ? 1 : size.z >= size.x ? 2 : 0;
    glm::dvec3 result(0);
    result[axis] = up[axis] < 0 ? -1 : 1;
    return result;
}

// The quarter (or half) turn from one axis to another.
glm::dmat3 turn(glm::dvec3 from, glm::dvec3 to) {
    const glm::dvec3 axis = glm::cross(from, to);
    if (glm::dot(axis, axis) > 0) { // columns: images of x, y, z; v = (v.from) from + (v.axis) axis + rest
        const glm::dvec3 other = glm::cross(axis, from); // equals `to`
        const auto turned = [&](glm::dvec3 v) {
            return glm::dot(v, from) * to + glm::dot(v, axis) * axis - glm::dot(v, other) * from;
        };
        return {turned({1, 0, 0}), turned({0, 1, 0}), turned({0, 0, 1})};
    }
    if (glm::dot(from, to) > 0) return glm::dmat3(1);
    const glm::dvec3 around = from.x != 0 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0); // upside down
    return glm::dmat3(2.0 * glm::outerProduct(around, around)) - glm::dmat3(1);
}

// New ids for the live things of one table, in order, from `first` on.
template <class T>
class Ids {
  public:
    explicit Ids(const Table<T>& from, std::uint32_t first) {
        from.each([&](Id<T> id, const T&) { map_[id.value] = {first++}; });
    }
    Id<T> operator()(Id<T> old) const {
        const auto it = map_.find(old.value);
        return it == map_.end() ? Id<T>{} : it->second;
    }
    void put(std::uint32_t old, Id<T> now) { map_[old] = now; }

  private:
    std::unordered_map<std::uint32_t, Id<T>> map_;
};

// Other changes to an item in its new place.
struct Place {
    glm::dmat4 frame;
    Id<Group> group; // around all of them
    template <class T>
    void put(T&) const {}
    void put(Group& g) const {
        if (!g.parent) g.parent = group;
    }
    void put(Instance& i) const {
        if (!i.group) i.group = group;
        i.object_to_world = frame * i.object_to_world;
    }
    void put(Light& l) const { l.light_to_world = frame * l.light_to_world; }
};

template <class T>
std::set<std::string> names_of(const Table<T>& slots) {
    std::set<std::string> names;
    slots.each([&](auto, const T& item) { names.insert(item.name); });
    return names;
}

} // namespace

std::string free_name(const std::string& name, std::set<std::string>& taken) {
    std::string result = name;
    for (unsigned number = 2; !taken.insert(result).second; ++number)
        result = name + " " + std::to_string(number);
    return result;
}

glm::dmat4 frame_change(const Scene& into, const Scene& from) {
    const Camera *there = active_camera(into), *here = active_camera(from);
    if (!there || !here) return glm::dmat4(1);
    const glm::dvec3 up = up_axis(*there);
    glm::dmat3 change = turn(up_axis(*here), up);
    const auto mirrored = [](const Camera& c) { return glm::determinant(glm::dmat3(c.camera_to_world)) < 0; };
    if (mirrored(*there) != mirrored(*here)) { // along the last axis that is not up: z if y is up
        const int axis = up.z != 0 ? 1 : 2;
        for (int column = 0; column < 3; ++column)
            change[column][axis] = -change[column][axis];
    }
    return glm::dmat4(change);
}

Merged merge(const Scene& into, const Scene& whole, const std::string& name) {
    // Items used only by the environment or camera, or not at all, are not merged.
    Scene from = whole;
    from.environment.value.reset();
    from.settings.value.camera_medium = {};
    apply(from, remove_unused(from));
    const auto shared = shared_materials(into, from);
    Edit had;
    for (const auto& [id, same] : shared) // the document's are used instead
        had.changes.push_back(Change<Material>{{id}, from.materials[{id}], std::nullopt});
    apply(from, had);
    apply(from, remove_unused(from));

    Merged result;
    const std::vector<Id<Group>> links = name.empty() ? std::vector<Id<Group>>{} : all_links(from);
    const Id<Group> link = links.size() == 1 ? links[0] : Id<Group>{}; // needs no group around it
    result.edit.label = (link ? "Link " : "Insert ") + name;
    // The enclosing group comes first, before the inserted groups.
    const bool several = !link && !name.empty() && from.instances.live() + from.lights.live() > 1;
    if (several) result.group = into.groups.next();
    auto ids = std::apply(
        [&]<class... T>(const Kind<T>&... kind) {
            return std::tuple{Ids<T>(from.*kind.table, (into.*kind.table).next().value +
                                                           (std::is_same_v<T, Group> && several ? 1u : 0u))...};
        },
        kinds);
    for (const auto& [id, same] : shared)
        std::get<Ids<Material>>(ids).put(id, same);
    const Place place{.frame = frame_change(into, from), .group = result.group};
    each_kind([&]<class T>(const Kind<T>& kind) {
        if constexpr (!std::is_same_v<T, Camera>) {
            std::set<std::string> taken = names_of(into.*kind.table);
            if constexpr (std::is_same_v<T, Group>)
                if (several)
                    result.edit.changes.push_back(Change<Group>{
                        result.group, std::nullopt, Group{.name = free_name(name, taken), .parent = {}, .origin = {}}});
            (from.*kind.table).each([&](Id<T> id, const T& item) {
                T copy = item;
                copy.name = free_name(copy.name, taken);
                visit_references(copy, [&]<class X>(Id<X>& target) { target = std::get<Ids<X>>(ids)(target); });
                place.put(copy);
                result.edit.changes.push_back(Change<T>{std::get<Ids<T>>(ids)(id), std::nullopt, std::move(copy)});
            });
        }
    });
    if (link) result.group = std::get<Ids<Group>>(ids)(link);
    from.instances.each(
        [&](Id<Instance> id, const Instance&) { result.instances.push_back(std::get<Ids<Instance>>(ids)(id)); });
    return result;
}

} // namespace restage::scene

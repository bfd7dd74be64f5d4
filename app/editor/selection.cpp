// SPDX-License-Identifier: Apache-2.0
#include "selection.hpp"

#include "scene/edits_groups.hpp"

#include <algorithm>
#include <cstddef>

namespace restage::editor {

void Selection::set(std::span<const InstanceId> ids, Mode mode) {
    light_ = {};
    if (mode == Mode::replace) {
        instances_.clear();
        members_.clear();
    }
    const bool all_there = std::all_of(ids.begin(), ids.end(), [&](InstanceId id) { return members_.contains(id); });
    const std::unordered_set<InstanceId> given(ids.begin(), ids.end());
    std::erase_if(instances_, [&](InstanceId id) { return given.contains(id) && members_.erase(id) > 0; });
    if (mode == Mode::toggle && all_there) return;
    // Each once; of duplicates the last position counts, as the last one is the active object.
    const std::size_t before = instances_.size();
    for (auto id = ids.rbegin(); id != ids.rend(); ++id)
        if (members_.insert(*id).second) instances_.push_back(*id);
    std::reverse(instances_.begin() + std::ptrdiff_t(before), instances_.end());
}

void Selection::set_light(scene::Id<scene::Light> light) {
    clear();
    light_ = light;
}

void Selection::clear() {
    instances_.clear();
    members_.clear();
    light_ = {};
}

void Selection::prune(const scene::Scene& scene) {
    std::erase_if(instances_, [&](InstanceId id) { return !scene.instances.find(id) && members_.erase(id) > 0; });
    if (!scene.lights.find(light_)) light_ = {};
    if (!scene.groups.find(entered_)) entered_ = {};
}

bool is_within(const scene::Scene& scene, GroupId inner, GroupId outer) {
    return scene::is_in_group(scene, inner, outer);
}

std::vector<InstanceId> instances_in(const scene::Scene& scene, GroupId group) {
    std::vector<InstanceId> found;
    scene.instances.each([&](InstanceId id, const scene::Instance& instance) {
        if (is_within(scene, instance.group, group)) found.push_back(id);
    });
    return found;
}

GroupId Selection::click_group(const scene::Scene& scene, InstanceId id) const {
    const scene::Instance* instance = scene.instances.find(id);
    if (!instance) return {};
    GroupId outermost;
    for (GroupId group = instance->group; group && group != entered_;) {
        outermost = group;
        const scene::Group* item = scene.groups.find(group);
        group = item ? item->parent : GroupId{};
    }
    // It is not in the entered group: the pick leaves that group.
    return outermost;
}

std::vector<InstanceId> Selection::click_target(const scene::Scene& scene, InstanceId id) const {
    const GroupId group = click_group(scene, id);
    if (!group) return {id};
    auto all = instances_in(scene, group);
    // The object that was hit becomes the active one.
    std::erase(all, id);
    all.push_back(id);
    return all;
}

scene::Bounds Selection::bounds(const scene::Scene& scene) const {
    scene::Bounds bounds;
    for (const InstanceId id : instances_)
        if (scene.instances.find(id)) bounds.add(scene::world_bounds(scene, id));
    if (const scene::Light* light = scene.lights.find(light_)) bounds.add(glm::dvec3(light->light_to_world[3]));
    return bounds;
}

} // namespace restage::editor

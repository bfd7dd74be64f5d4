// SPDX-License-Identifier: Apache-2.0
#include "selection.hpp"

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
    if (entered_.group && !scene.groups.find(entered_.group)) entered_ = {};
}

std::vector<Whole> Selection::wholes(const scene::Scene& scene, InstanceId id) const {
    static const query::Things none;
    return query::wholes_around(scene, whole_things ? things : none, id);
}

Whole Selection::click_whole(const scene::Scene& scene, InstanceId id) const {
    const std::vector<Whole> around = wholes(scene, id);
    auto at = around.begin();
    if (const auto in = std::find(around.begin(), around.end(), entered_); in != around.end()) at = in + 1;
    return at == around.end() ? Whole{} : *at;
}

GroupId Selection::click_group(const scene::Scene& scene, InstanceId id) const {
    const std::vector<Whole> around = wholes(scene, id);
    auto at = around.begin();
    if (const auto in = std::find(around.begin(), around.end(), entered_); in != around.end()) at = in + 1;
    at = std::find_if(at, around.end(), [](const Whole& whole) { return !whole.thing; });
    return at == around.end() ? GroupId{} : at->group;
}

std::vector<InstanceId> Selection::click_target(const scene::Scene& scene, InstanceId id) const {
    const Whole whole = click_whole(scene, id);
    if (!whole) return {id};
    auto all = query::members_of(scene, things, whole);
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

// SPDX-License-Identifier: Apache-2.0
#include "query/wholes.hpp"

#include "scene/edits_groups.hpp"

#include <algorithm>

namespace restage::query {

using GroupId = scene::Id<scene::Group>;
using InstanceId = scene::Id<scene::Instance>;

std::vector<InstanceId> instances_in(const scene::Scene& scene, GroupId group) {
    std::vector<InstanceId> found;
    scene.instances.each([&](InstanceId id, const scene::Instance& instance) {
        if (scene::is_in_group(scene, instance.group, group)) found.push_back(id);
    });
    return found;
}

namespace {

// The outermost group around it that the user made.
GroupId own_group(const scene::Scene& scene, const Things& things, InstanceId id) {
    GroupId outermost, group = scene.instances[id].group;
    for (std::size_t depth = 0; scene.groups.find(group) && depth <= scene.groups.size(); ++depth) {
        if (group.value > things.imported_groups) outermost = group;
        group = scene.groups[group].parent;
    }
    return outermost;
}

} // namespace

std::vector<Whole> wholes_around(const scene::Scene& scene, const Things& things, InstanceId id) {
    const scene::Instance* instance = scene.instances.find(id);
    if (!instance) return {};
    std::vector<Whole> wholes;
    GroupId group = instance->group;
    for (std::size_t depth = 0; scene.groups.find(group) && depth <= scene.groups.size(); ++depth) {
        if (!things.is_collection(group)) wholes.push_back({.group = group});
        group = scene.groups[group].parent;
    }
    std::reverse(wholes.begin(), wholes.end());
    if (const std::uint32_t number = things.number(id)) {
        const Whole thing{.group = own_group(scene, things, id), .thing = number};
        const auto around = std::find(wholes.begin(), wholes.end(), Whole{.group = thing.group});
        const std::size_t members = members_of(scene, things, thing).size();
        if (!thing.group)
            wholes.insert(wholes.begin(), thing);
        else if (members > 1 && members < instances_in(scene, thing.group).size())
            wholes.insert(around + 1, thing);
    }
    return wholes;
}

std::vector<InstanceId> members_of(const scene::Scene& scene, const Things& things, const Whole& whole) {
    if (!whole.thing) return instances_in(scene, whole.group);
    std::vector<InstanceId> members;
    if (whole.thing < things.members.size())
        for (const InstanceId id : things.members[whole.thing])
            if (scene.instances.find(id) && own_group(scene, things, id) == whole.group) members.push_back(id);
    return members;
}

} // namespace restage::query

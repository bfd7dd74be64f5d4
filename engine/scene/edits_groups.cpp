// SPDX-License-Identifier: Apache-2.0
#include "scene/edits_groups.hpp"

#include <algorithm>

namespace restage::scene {

bool is_in_group(const Scene& scene, Id<Group> inner, Id<Group> outer) {
    std::size_t steps = 0; // a file may have loops
    for (const Group* group = scene.groups.find(inner); group && steps <= scene.groups.size(); ++steps) {
        if (inner == outer) return true;
        inner = group->parent;
        group = scene.groups.find(inner);
    }
    return false;
}

Result<Edit> reparent(const Scene& scene, std::span<const Id<Instance>> instances, std::span<const Id<Group>> groups,
                      Id<Group> to) {
    const Group* target = scene.groups.find(to);
    if (to && !target) return fail("the group no longer exists");
    const auto comes_along = [&](Id<Group> parent) {
        return std::ranges::any_of(groups, [&](Id<Group> group) { return is_in_group(scene, parent, group); });
    };
    Edit edit{target ? "Move to " + target->name : "Take out of group", {}};
    for (const Id<Group> id : groups) {
        const Group* group = scene.groups.find(id);
        if (!group || group->parent == to || comes_along(group->parent)) continue;
        if (is_in_group(scene, to, id)) return fail("\"" + group->name + "\" cannot be moved into itself");
        Group after = *group;
        after.parent = to;
        edit.changes.push_back(Change<Group>{id, *group, std::move(after)});
    }
    for (const Id<Instance> id : instances) {
        const Instance* instance = scene.instances.find(id);
        if (!instance || instance->group == to || comes_along(instance->group)) continue;
        Instance after = *instance;
        after.group = to;
        edit.changes.push_back(Change<Instance>{id, *instance, std::move(after)});
    }
    if (edit.changes.empty()) return fail(target ? "they are in that group already" : "they are in no group");
    return edit;
}

} // namespace restage::scene

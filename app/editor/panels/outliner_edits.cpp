// SPDX-License-Identifier: Apache-2.0
// The outliner's edits of groups.
#include "outliner.hpp"
#include "scene/edits.hpp"
#include "scene/edits_groups.hpp"
#include "scene/merge.hpp"

#include <algorithm>
#include <set>

namespace restage::editor {

void move_to_group(SelectContext& e, GroupId to, const std::vector<GroupId>& groups) {
    e.edit([ids = e.selection.instances(), groups, to](const scene::Scene& s) {
        return scene::reparent(s, ids, groups, to);
    });
}

std::vector<GroupId> dragged_groups(const SelectContext& e, GroupId group) {
    const scene::Scene& s = e.scene();
    std::vector<bool> whole(s.groups.size() + 1, true), used(s.groups.size() + 1, false);
    s.instances.each([&](InstanceId id, const scene::Instance& instance) {
        std::size_t steps = 0;
        for (GroupId at = instance.group; const scene::Group* item = s.groups.find(at); at = item->parent) {
            used[at.value] = true;
            if (!e.selection.contains(id)) whole[at.value] = false;
            if (++steps > s.groups.size()) break;
        }
    });
    std::vector<GroupId> found;
    s.groups.each([&](GroupId id, const scene::Group& item) {
        const bool outermost = !s.groups.find(item.parent) || !whole[item.parent.value];
        if (whole[id.value] && used[id.value] && outermost) found.push_back(id);
    });
    return std::ranges::find(found, group) != found.end() ? found : std::vector<GroupId>();
}

void group_selected(SelectContext& e) {
    e.edit([ids = e.selection.instances()](const scene::Scene& s) {
        std::set<std::string> taken;
        s.groups.each([&](auto, const scene::Group& g) { taken.insert(g.name); });
        const GroupId id = s.groups.next();
        scene::Edit edit = scene::insert(s, scene::Group{.name = scene::free_name("Group", taken)}, "Group");
        for (const InstanceId one : ids) {
            scene::Instance after = s.instances[one];
            after.group = id;
            edit.changes.push_back(scene::Change<scene::Instance>{one, s.instances[one], std::move(after)});
        }
        return Result<scene::Edit>(std::move(edit));
    });
}

void ungroup(EditContext& e, GroupId id) {
    e.edit([id](const scene::Scene& s) {
        const scene::Group* gone = s.groups.find(id);
        if (!gone) return Result<scene::Edit>(fail("the group no longer exists"));
        scene::Edit edit{"Ungroup " + gone->name, {}};
        s.instances.each([&](InstanceId one, const scene::Instance& i) {
            if (i.group != id) return;
            scene::Instance after = i;
            after.group = gone->parent;
            edit.changes.push_back(scene::Change<scene::Instance>{one, i, std::move(after)});
        });
        s.groups.each([&](GroupId one, const scene::Group& g) {
            if (g.parent != id) return;
            scene::Group after = g;
            after.parent = gone->parent;
            edit.changes.push_back(scene::Change<scene::Group>{one, g, std::move(after)});
        });
        edit.changes.push_back(scene::Change<scene::Group>{id, *gone, std::nullopt});
        return Result<scene::Edit>(std::move(edit));
    });
}

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
// The outliner's edits of groups.
#include "outliner.hpp"
#include "scene/edits.hpp"
#include "scene/merge.hpp"

#include <set>

namespace restage::editor {

void move_to_group(SelectContext& e, GroupId group) {
    e.edit([ids = e.selection.instances(), group](const scene::Scene& s) {
        const scene::Group* to = s.groups.find(group);
        scene::Edit edit{to ? "Move to " + to->name : "Take out of group", {}};
        for (const InstanceId id : ids) {
            scene::Instance after = s.instances[id];
            after.group = group;
            edit.changes.push_back(scene::Change<scene::Instance>{id, s.instances[id], std::move(after)});
        }
        return Result<scene::Edit>(std::move(edit));
    });
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

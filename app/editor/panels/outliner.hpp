// SPDX-License-Identifier: Apache-2.0
// The outliner's list of rows: the drawn part of the scene's tree, in order.
#pragma once

#include "contexts.hpp"
#include "state.hpp"

namespace restage::editor {

// Opens the groups of a selection made elsewhere, and updates the list.
void update_rows(const SelectContext& editor, OutlinerState& state);
// The list of that scene. Visits the objects changed since the last call, and rebuilds it if their names, groups or
// visibility, a filter or an open group changed. With 20,000 objects 1 us after a move, 0.3 ms for all, 4 ms with a
// search.
void update_rows(const scene::Scene& scene, OutlinerState& state);
// The row of an object; -1 = not listed.
int find_row(const OutlinerState& state, InstanceId id);

// Up and down move through the listed rows, with Shift extending the selection; right opens a group, left
// closes it or goes to its parent; F2 renames. Call within the list's window.
void outliner_keys(SelectContext& editor, OutlinerState& state);
void start_renaming(OutlinerState& state, const OutlinerState::Row& row, const std::string& name);

// The selected objects, and these groups with all they hold; none = out of their groups.
void move_to_group(SelectContext& editor, GroupId to, const std::vector<GroupId>& groups = {});
// The outermost groups that are selected whole, if it is one of them; else none: it alone is dragged.
std::vector<GroupId> dragged_groups(const SelectContext& editor, GroupId group);
void group_selected(SelectContext& editor);
void ungroup(EditContext& editor, GroupId group); // its contents move to the parent group

} // namespace restage::editor

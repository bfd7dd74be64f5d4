// SPDX-License-Identifier: Apache-2.0
// The outliner's list of rows: what is drawn of the scene's tree, in order.
#pragma once

#include "panel_context.hpp"
#include "state.hpp"

namespace restage::editor {

// Rebuilds the list when the scene, a filter or an open group has changed: some 2 ms for 20000 objects.
void update_rows(const PanelContext& editor, OutlinerState& state);
// The row of an object; -1 = not listed.
int find_row(const OutlinerState& state, InstanceId id);

// Up and down go through the listed rows, with Shift adding them to the selection; right opens a group, left
// closes it or goes to its parent; F2 renames. Within the list's window.
void outliner_keys(PanelContext& editor, OutlinerState& state);
void start_renaming(OutlinerState& state, const OutlinerState::Row& row, const std::string& name);

void move_to_group(PanelContext& editor, GroupId group); // the selected objects; none = out of their groups
void group_selected(PanelContext& editor);
void ungroup(PanelContext& editor, GroupId group); // its contents move to the parent group

} // namespace restage::editor

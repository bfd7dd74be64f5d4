// SPDX-License-Identifier: Apache-2.0
// The outliner's list of rows: what is drawn of the scene's tree, in order.
#pragma once

#include "panel_context.hpp"
#include "state.hpp"

namespace restage::editor {

// Makes the list anew when the scene, a filter or an open group has changed: some 2 ms for 20000 objects.
void update_rows(const PanelContext& editor, OutlinerState& state);
// The row of an object; -1 = it is not listed.
int find_row(const OutlinerState& state, InstanceId id);

// Up and down go through the rows as they are listed, with Shift what is passed is added; right opens a group, left
// closes it or goes to the one around; F2 renames. Within the list's window.
void outliner_keys(PanelContext& editor, OutlinerState& state);
void start_renaming(OutlinerState& state, const OutlinerState::Row& row, const std::string& name);

void move_to_group(PanelContext& editor, GroupId group); // the selected objects; none = out of theirs
void group_selected(PanelContext& editor);
void ungroup(PanelContext& editor, GroupId group); // what is in it goes to the group around it

} // namespace restage::editor

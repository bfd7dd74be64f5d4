// SPDX-License-Identifier: Apache-2.0
// The outliner's list of rows: what is drawn of the scene's tree, in order.
#pragma once

#include "editor.hpp"
#include "state.hpp"

namespace restage::editor {

// Makes the list anew when the scene, a filter or an open group has changed: some 2 ms for 20000 objects.
void update_rows(const Editor& editor, OutlinerState& state);
// The row of an object; -1 = it is not listed.
int find_row(const OutlinerState& state, InstanceId id);

void move_to_group(Editor& editor, GroupId group); // the selected objects; none = out of theirs
void group_selected(Editor& editor);
void ungroup(Editor& editor, GroupId group); // what is in it goes to the group around it

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
// Drawing the path of an array (arrange.hpp) in the picture: clicks on surfaces are its points, and the copies follow
// at once. It begins at the selection. Enter ends drawing, Backspace takes a point back, Esc removes path and copies.
#pragma once

namespace restage::editor {

class PanelContext;
class SelectContext;

void begin_path(SelectContext& editor);
// Called by the viewport before it picks: draws the path, and true while clicks are its points.
bool run_path_tool(PanelContext& editor, bool over);

} // namespace restage::editor

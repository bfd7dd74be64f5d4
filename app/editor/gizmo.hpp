// SPDX-License-Identifier: Apache-2.0
// Gizmo: ImGuizmo's handles on what is selected. What a drag of them means: drag.hpp.
#pragma once

#include <imgui.h>

namespace restage::editor {

class PanelContext;

struct GizmoState {
    bool wants_mouse = false; // over a handle, or dragging one
    bool knob = false; // over the knob between the move handles, or holding it
};

// Draws the handles over the picture (its rectangle on screen) and asks for the changes.
GizmoState draw_gizmo(PanelContext& editor, ImVec2 corner, ImVec2 size);
// Lets go of them.
void release_gizmo();

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
// Gizmo: ImGuizmo's handles on the selection. drag.hpp implements drags of them.
#pragma once

#include <imgui.h>

namespace restage::editor {

class PanelContext;

struct GizmoState {
    bool wants_mouse = false; // over a handle, or dragging one
    bool knob = false; // over the knob between the move handles, or dragging it
};

// Draws the handles over the picture (its rectangle on screen) and requests the changes.
GizmoState draw_gizmo(PanelContext& editor, ImVec2 corner, ImVec2 size);
// Releases them.
void release_gizmo();

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
// Gizmo: ImGuizmo's handles on what is selected. A drag is one step of the history; Alt copies first; Ctrl snaps.
#pragma once

#include "selection.hpp"

#include <imgui.h>
#include <glm/glm.hpp>
#include <optional>
#include <utility>
#include <vector>

namespace restage::editor {

class Editor;

// A drag as it runs: what was selected, where it was, and the handles' frame, when it began.
struct GizmoDrag {
    bool active = false;
    bool copied = false;
    std::vector<std::pair<InstanceId, glm::dmat4>> start;
    std::optional<glm::dmat4> light_start;
    glm::dmat4 frame{1};  // of the handles, at the start, about the pivot
    glm::mat4 current{1}; // the same now, as ImGuizmo has it
    glm::dvec3 pivot{0};
};

// For drags of the handles and of the object itself: notes what is dragged, or copies of it, and where it is; and asks
// that it is where `by` brings it from there. Editor::end_gesture() ends it.
void begin_drag(Editor& editor, GizmoDrag& drag, bool copy);
void ask_drag(Editor& editor, const GizmoDrag& drag, const glm::dmat4& by, const char* verb);

// Draws the handles over the picture (its rectangle on screen) and asks for the moves. True while they want the mouse.
bool draw_gizmo(Editor& editor, ImVec2 corner, ImVec2 size);

} // namespace restage::editor

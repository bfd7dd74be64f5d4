// SPDX-License-Identifier: Apache-2.0
// Key chords typed within one slow frame.
#pragma once

namespace restage::editor {

// ImGui::NewFrame(), but a modifier that changes after a key was pressed waits for the frame after, with all events
// behind it. Dear ImGui spreads simultaneous events over frames, such as a key's press and release; but it takes
// Ctrl down, A down and Ctrl up into a single frame, in which a text field sees a bare A.
void begin_imgui_frame();

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
// Key chords typed within one slow frame.
#pragma once

namespace restage::editor {

// ImGui::NewFrame(), except that a modifier change after a key press is deferred to the next frame, with all later
// events. Dear ImGui spreads simultaneous events over frames, such as a key's press and release; but it takes
// Ctrl down, A down and Ctrl up into a single frame, in which a text field sees A without Ctrl.
void begin_imgui_frame();

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
// Where the panels are docked.
#pragma once

#include <imgui.h>

namespace restage::editor {

// Where panels are when no layout file says otherwise.
void first_layout(ImGuiID space, ImVec2 size);
// A layout that was saved in a large window, or at another scale, leaves the picture next to nothing in a small one:
// docked panels shrink until it has its least size. Before the dock space of this frame.
void keep_picture_large(ImGuiID space, ImVec2 size);

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
// Docking of the panels.
#pragma once

#include <imgui.h>

namespace restage::editor {

// The layout if there is no layout file.
void first_layout(ImGuiID space, ImVec2 size);
// A layout saved in a large window, or at another scale, would leave little room for the picture in a small one:
// shrinks docked panels until the picture has its minimum size. Call before this frame's dock space.
void keep_picture_large(ImGuiID space, ImVec2 size);

} // namespace restage::editor

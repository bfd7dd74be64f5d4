// SPDX-License-Identifier: Apache-2.0
// Damage: the part of the window that differs from the previous frame, so that only that is redrawn. Most frames
// change the picture and a few numbers; without a GPU, drawing all panels each time took more than half of the
// CPU time from the renderer.
#pragma once

#include <imgui.h>
#include <imgui_internal.h>
#include <cstdint>
#include <vector>

namespace restage::editor {

class Damage {
  public:
    // The difference from the draw data of the last call, in Dear ImGui's coordinates; Min >= Max: nothing. Call before
    // the backend uploads textures: those still pending are the changed ones.
    ImRect update(const ImDrawData& data);
    // Everything counts as different next time: the window's content is lost.
    void forget() { forgotten_ = true; }

    // Restricts drawing to a rectangle.
    static void clip(ImDrawData& data, const ImRect& rect);

  private:
    struct Item { // a draw command
        std::uint64_t hash = 0; // of all it draws, independent of buffer offsets
        ImRect bounds; // of its visible triangles
        bool texture_changed = false;
    };
    std::vector<Item> last_, items_;
    bool forgotten_ = true;
};

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
#include "chords.hpp"

#include <imgui.h>
#include <imgui_internal.h>
#include <algorithm>
#include <vector>

namespace restage::editor {

namespace {

bool is_modifier(ImGuiKey key) {
    return (key & ImGuiMod_Mask_) != 0 || (key >= ImGuiKey_LeftCtrl && key <= ImGuiKey_RightSuper);
}

} // namespace

void begin_imgui_frame() {
    ImVector<ImGuiInputEvent>& queue = ImGui::GetCurrentContext()->InputEventsQueue;
    bool pressed = false;
    const auto* split = std::find_if(queue.begin(), queue.end(), [&](const ImGuiInputEvent& event) {
        if (event.Type != ImGuiInputEventType_Key) return false;
        if (is_modifier(event.Key.Key)) return pressed;
        pressed = pressed || event.Key.Down;
        return false;
    });
    const std::vector<ImGuiInputEvent> later(split, static_cast<const ImGuiInputEvent*>(queue.end()));
    queue.resize(queue.Size - int(later.size()));
    ImGui::NewFrame();
    for (const ImGuiInputEvent& event : later)
        queue.push_back(event);
}

} // namespace restage::editor

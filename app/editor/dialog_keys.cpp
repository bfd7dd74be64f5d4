// SPDX-License-Identifier: Apache-2.0
#include "dialog_keys.hpp"

#include <imgui.h>
#include <imgui_internal.h>

namespace restage::editor {

KeyNavigation::KeyNavigation() : was_on_((ImGui::GetIO().ConfigFlags & ImGuiConfigFlags_NavEnableKeyboard) != 0) {
    ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
}

KeyNavigation::~KeyNavigation() {
    if (!was_on_ && ImGui::GetCurrentContext()) // the editor outlives the window
        ImGui::GetIO().ConfigFlags &= ~ImGuiConfigFlags_NavEnableKeyboard;
}

bool dialog_escape(bool& list_open) {
    const bool pressed = ImGui::IsKeyPressed(ImGuiKey_Escape, false), of_list = list_open;
    if (pressed && of_list) ImGui::ClosePopupsOverWindow(ImGui::GetCurrentWindow(), false);
    list_open = ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId);
    return pressed && !of_list;
}

} // namespace restage::editor

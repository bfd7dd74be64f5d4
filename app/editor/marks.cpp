// SPDX-License-Identifier: Apache-2.0
#include "marks.hpp"

#include <imgui.h>
#include <imgui_internal.h>

namespace restage::editor {

namespace {

// Dear ImGui settles a window's size and place in its first frames: until then positions of its contents are not
// valid for clicks.
bool settled(const ImGuiWindow* window) {
    for (; window; window = window->ParentWindow)
        if (window->Appearing || window->Hidden || window->AutoFitFramesX > 0 || window->AutoFitFramesY > 0)
            return false;
    return true;
}

} // namespace

void Marks::item(const std::string& name) {
    if (!settled(ImGui::GetCurrentWindow())) return;
    const ImVec2 a = ImGui::GetItemRectMin(), b = ImGui::GetItemRectMax();
    marks_[name] = {a.x, a.y, b.x, b.y, ImGui::GetItemID()};
}

void Marks::area(const std::string& name, const ImVec2& lower, const ImVec2& upper) {
    if (settled(ImGui::GetCurrentWindow())) marks_[name] = {lower.x, lower.y, upper.x, upper.y};
}

void Marks::tab(const std::string& name) {
    const ImGuiWindow* window = ImGui::GetCurrentWindow();
    if (!window->DockNode || !settled(window->DockNode->HostWindow)) return;
    const ImRect& tab = window->DC.DockTabItemRect;
    marks_[name] = {tab.Min.x, tab.Min.y, tab.Max.x, tab.Max.y};
}

const Marks::Mark* Marks::find(std::string_view name) const {
    const auto found = marks_.find(name);
    return found == marks_.end() ? nullptr : &found->second;
}

} // namespace restage::editor

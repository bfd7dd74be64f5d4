// SPDX-License-Identifier: Apache-2.0
#include "layout.hpp"

#include "panels/panels.hpp"

#include <imgui_internal.h>
#include <algorithm>

namespace restage::editor {

// Panels are as wide as their contents need at this scale; in a
// small window the outliner shares the right side with the inspector, so that the picture keeps more than half of it.
void first_layout(ImGuiID space, ImVec2 size) {
    ImGui::DockBuilderRemoveNode(space);
    ImGui::DockBuilderAddNode(space, ImGuiDockNodeFlags_DockSpace);
    ImGui::DockBuilderSetNodeSize(space, size);
    const float scale = ImGui::GetStyle().FontScaleMain;
    const float side = std::max(0.24f * size.x, std::min(300 * scale, 0.4f * size.x));
    const float list = std::max(0.17f * size.x, 210 * scale);
    const bool small = side + list > 0.46f * size.x;
    const float low = std::clamp(190 * scale, 0.24f * size.y, 0.34f * size.y);
    ImGuiID center = space, left = 0;
    ImGuiID right = ImGui::DockBuilderSplitNode(center, ImGuiDir_Right, side / size.x, nullptr, &center);
    if (small)
        left = ImGui::DockBuilderSplitNode(right, ImGuiDir_Up, 0.36f, nullptr, &right);
    else
        left = ImGui::DockBuilderSplitNode(center, ImGuiDir_Left, list / (size.x - side), nullptr, &center);
    const ImGuiID bottom = ImGui::DockBuilderSplitNode(center, ImGuiDir_Down, low / size.y, nullptr, &center);
    for (const Panel& panel : all_panels()) {
        if (panel.dock == Dock::floating) continue;
        ImGui::DockBuilderDockWindow(panel.title, panel.dock == Dock::left     ? left
                                                  : panel.dock == Dock::right  ? right
                                                  : panel.dock == Dock::bottom ? bottom
                                                                               : center);
    }
    if (ImGuiDockNode* node = ImGui::DockBuilderGetNode(center)) node->LocalFlags |= ImGuiDockNodeFlags_AutoHideTabBar;
    ImGui::DockBuilderFinish(space);
}

void keep_picture_large(ImGuiID space, ImVec2 size) {
    ImGuiDockNode* center = ImGui::DockBuilderGetCentralNode(space);
    if (!center || size.x <= 0 || size.y <= 0) return;
    const float scale = ImGui::GetStyle().FontScaleMain;
    const ImVec2 least(std::min(0.45f * size.x, 640 * scale), std::min(0.45f * size.y, 400 * scale));
    constexpr float narrow = 90; // of a shrunk panel [at scale 1]
    for (const int axis : {0, 1}) {
        // The width of the docked nodes next to the picture, from the picture outwards.
        float taken = 0;
        for (const ImGuiDockNode* node = center; node->ParentNode; node = node->ParentNode) {
            const ImGuiDockNode* parent = node->ParentNode;
            const ImGuiDockNode* other = parent->ChildNodes[parent->ChildNodes[0] == node ? 1 : 0];
            if (int(parent->SplitAxis) == axis && other && other->IsVisible) taken += other->SizeRef[axis];
        }
        const float room = std::max(size[std::size_t(axis)] - least[std::size_t(axis)], 0.f);
        if (taken <= room) continue;
        for (ImGuiDockNode* node = center; node->ParentNode; node = node->ParentNode) {
            ImGuiDockNode* parent = node->ParentNode;
            ImGuiDockNode* other = parent->ChildNodes[parent->ChildNodes[0] == node ? 1 : 0];
            if (int(parent->SplitAxis) != axis || !other || !other->IsVisible) continue;
            other->SizeRef[axis] = std::max(other->SizeRef[axis] * room / taken, narrow * scale);
        }
    }
}

} // namespace restage::editor

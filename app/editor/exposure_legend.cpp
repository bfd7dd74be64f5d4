// SPDX-License-Identifier: Apache-2.0
#include "exposure_legend.hpp"

#include "theme.hpp"
#include "view/display.hpp"

#include <algorithm>
#include <cmath>

namespace restage::editor {

void draw_exposure_legend(PanelUi& e, ImVec2 corner, ImVec2 size) {
    const auto zones = view::exposure_zones();
    const float scale = ImGui::GetStyle().FontScaleMain, pad = 6 * scale;
    const char* title = "Stops";
    float wide = ImGui::CalcTextSize(title).x;
    for (const view::ExposureZone& zone : zones)
        wide = std::max(wide, ImGui::CalcTextSize(zone.label).x);
    // Rows shrink in a small picture; their labels are then left out, every second or more.
    const float line = ImGui::GetTextLineHeight(), rows = float(zones.size() + 1);
    const float row = std::min(line + 2 * scale, (size.y - 4 * pad) / rows);
    const float swatch = 1.4f * line;
    const auto every = std::size_t(std::max(1.f, std::ceil(line / std::max(row, 1.f))));
    const ImVec2 b(corner.x + size.x - pad, corner.y + 2 * pad + rows * row + pad);
    const ImVec2 a(b.x - (3 * pad + swatch + wide), corner.y + pad);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled(a, b, ImGui::GetColorU32(ImGuiCol_PopupBg), 3 * scale);
    const ImU32 text = ImGui::GetColorU32(ImGuiCol_Text);
    float y = a.y + pad;
    draw->AddText({a.x + pad, y + (row - line) / 2}, text, title);
    for (std::size_t i = zones.size(); i-- > 0;) {
        y += row;
        draw->AddRectFilled({a.x + pad, y}, {a.x + pad + swatch, y + row}, zones[i].color);
        if (i % every == 0) draw->AddText({a.x + 2 * pad + swatch, y + (row - line) / 2}, text, zones[i].label);
    }
    e.mark("exposure.legend", a, b);
}

} // namespace restage::editor

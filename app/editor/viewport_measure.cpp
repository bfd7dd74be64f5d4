// SPDX-License-Identifier: Apache-2.0
// The measure tool in the picture.
#include "panel_context.hpp"
#include "query/measure.hpp"
#include "theme.hpp"
#include "viewport.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <optional>

namespace restage::editor {

bool Viewport::run_measuring(PanelContext& e, bool over) {
    Measurement& m = measurement;
    if (!m.on) return false;
    const float scale = ImGui::GetStyle().FontScaleMain;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    constexpr float near = 9; // a vertex attracts from there [pixel at scale 1]
    std::optional<query::SurfacePoint> at;
    if (over) {
        at = query::surface_point(e.scene(), e.camera(), film_point(mouse), e.film_aspect(),
                                  double(near * scale / size.y));
        ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
        if (at && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
            if (m.points.size() == 2) m.points.clear();
            m.points.push_back(at->position);
        }
    }
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->PushClipRect(corner, {corner.x + size.x, corner.y + size.y}, true);
    const ImU32 line = ImGui::GetColorU32(colors::accent), ground = ImGui::GetColorU32(colors::over_picture);
    std::vector<glm::dvec3> ends = m.points;
    if (ends.size() == 1 && at) ends.push_back(at->position); // to the mouse
    const auto label = [&](const std::string& text, ImVec2 place, const char* mark) {
        const ImVec2 extent = ImGui::CalcTextSize(text.c_str());
        const ImVec2 lower(place.x - extent.x / 2 - 5 * scale, place.y - extent.y - 12 * scale);
        draw->AddRectFilled(lower, {lower.x + extent.x + 10 * scale, lower.y + extent.y + 6 * scale}, ground,
                            3 * scale);
        draw->AddText({lower.x + 5 * scale, lower.y + 3 * scale}, ImGui::GetColorU32(ImGuiCol_Text), text.c_str());
        e.mark(mark, lower, {lower.x + extent.x, lower.y + extent.y});
    };
    if (ends.size() == 2) {
        const auto a = on_screen(e, ends[0]), b = on_screen(e, ends[1]);
        const glm::dvec3 by = ends[1] - ends[0];
        if (a && b) {
            draw->AddLine(*a, *b, ground, 4 * scale);
            draw->AddLine(*a, *b, line, 2 * scale);
            label(fmt::format("{:.4g}   x {:.4g}  y {:.4g}  z {:.4g}", glm::length(by), by.x, by.y, by.z),
                  {(a->x + b->x) / 2, (a->y + b->y) / 2}, "measure.result");
        }
    }
    for (const glm::dvec3& point : m.points)
        if (const auto p = on_screen(e, point)) draw->AddCircleFilled(*p, 4 * scale, line);
    if (at)
        if (const auto p = on_screen(e, at->position)) {
            draw->AddCircle(*p, (at->vertex ? 7 : 4) * scale, line, 0, 2 * scale);
            if (at->vertex) draw->AddCircleFilled(*p, 2 * scale, line);
        }
    draw->PopClipRect();
    label(m.points.size() == 1 ? "Click the other end" : "Click two points: corners attract. Esc ends",
          {corner.x + size.x / 2, corner.y + 40 * scale}, "measure.hint");
    return true;
}

} // namespace restage::editor

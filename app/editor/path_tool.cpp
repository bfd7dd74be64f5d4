// SPDX-License-Identifier: Apache-2.0
#include "path_tool.hpp"

#include "arrange.hpp"
#include "panel_context.hpp"
#include "panels/state.hpp"
#include "query/navigation.hpp"
#include "query/raycast.hpp"
#include "theme.hpp"
#include "viewport.hpp"

#include <imgui.h>
#include <algorithm>
#include <optional>

namespace restage::editor {

namespace {

// The surface there, without what is repeated and its copies.
std::optional<glm::dvec3> surface_at(const PanelContext& e, ImVec2 screen) {
    const ArrangeState& a = e.panel_state->arrange;
    const query::ViewRay ray = query::view_ray(e.camera(), e.viewport.film_point(screen), e.film_aspect());
    const auto hits = query::raycast_all(e.scene(), ray.origin, ray.direction, [&](InstanceId id) {
        return e.selection.contains(id) || (a.live && std::ranges::find(a.live->copies, id) != a.live->copies.end());
    });
    if (hits.empty()) return std::nullopt;
    return hits[0].position;
}

void draw_path(PanelContext& e, const std::vector<glm::dvec3>& points, std::size_t clicked) {
    const float scale = ImGui::GetStyle().FontScaleMain;
    const Viewport& v = e.viewport;
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->PushClipRect(v.corner, {v.corner.x + v.size.x, v.corner.y + v.size.y}, true);
    const ImU32 ground = ImGui::GetColorU32(colors::over_picture), line = ImGui::GetColorU32(colors::accent);
    std::vector<ImVec2> shown;
    for (const glm::dvec3& p : scene::path_through(points, e.panel_state->arrange.array.smooth))
        if (const auto at = v.on_screen(e, p)) shown.push_back(*at);
    draw->AddPolyline(shown.data(), int(shown.size()), ground, 4 * scale);
    draw->AddPolyline(shown.data(), int(shown.size()), line, 2 * scale);
    for (std::size_t i = 0; i <= clicked && i < points.size(); ++i)
        if (const auto at = v.on_screen(e, points[i])) {
            draw->AddCircleFilled(*at, 5 * scale, ground);
            draw->AddCircleFilled(*at, 4 * scale, line);
        }
    draw->PopClipRect();
}

} // namespace

void begin_path(SelectContext& e) {
    ArrangeState& a = e.panel_state->arrange;
    cancel_array(e);
    a.array.kind = ArrayKind::path;
    a.array.path.clear();
    a.drawing = true;
}

bool run_path_tool(PanelContext& e, bool over) {
    ArrangeState& a = e.panel_state->arrange;
    if (e.selection.instances().empty() || ImGui::GetFrameCount() - a.drawn > 1) a.drawing = false; // the panel is gone
    if (a.array.kind != ArrayKind::path || !(a.drawing || array_is_live(e))) return false;
    std::vector<glm::dvec3> points{path_start(e)};
    points.insert(points.end(), a.array.path.begin(), a.array.path.end());
    const std::size_t clicked = a.array.path.size();
    if (!a.drawing) {
        draw_path(e, points, clicked);
        return false;
    }
    const auto at = over ? surface_at(e, ImGui::GetIO().MousePos) : std::nullopt;
    if (over) ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
    if (at && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        a.array.path.push_back(*at);
        change_array(e);
    } else if (clicked > 0 && ImGui::IsKeyPressed(ImGuiKey_Backspace, false) && !ImGui::GetIO().WantTextInput) {
        a.array.path.pop_back();
        change_array(e);
    } else if (at) {
        points.push_back(*at); // to the mouse
    }
    draw_path(e, points, clicked);
    const float scale = ImGui::GetStyle().FontScaleMain;
    const char* text = clicked == 0 ? "Click where the path goes on from the selection. Esc ends"
                                    : "Click the next point. Enter: done, Backspace: one back, Esc: no copies";
    const ImVec2 extent = ImGui::CalcTextSize(text);
    const Viewport& v = e.viewport;
    const ImVec2 lower(v.corner.x + (v.size.x - extent.x) / 2 - 5 * scale, v.corner.y + 20 * scale);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled(lower, {lower.x + extent.x + 10 * scale, lower.y + extent.y + 6 * scale},
                        ImGui::GetColorU32(colors::over_picture), 3 * scale);
    draw->AddText({lower.x + 5 * scale, lower.y + 3 * scale}, ImGui::GetColorU32(ImGuiCol_Text), text);
    e.mark("path.hint", lower, {lower.x + extent.x, lower.y + extent.y});
    return true;
}

} // namespace restage::editor

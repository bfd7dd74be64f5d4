// SPDX-License-Identifier: Apache-2.0
// The render region in the picture: drawn by a drag, shown as a frame with a button that closes it.
#include "panel_context.hpp"
#include "theme.hpp"
#include "viewport.hpp"

#include <imgui.h>
#include <algorithm>

namespace restage::editor {

bool Viewport::run_region(PanelContext& e, bool over) {
    RenderRegion& r = region;
    if (r.area && (r.document != e.document() || !(r.camera == e.camera())))
        r.end(); // the rest would be of another view
    if (!r.active()) return false;
    const float scale = ImGui::GetStyle().FontScaleMain;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const glm::dvec2 at = glm::clamp(film_point(mouse), 0.0, 1.0);
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const ImU32 line = ImGui::GetColorU32(colors::accent), ground = ImGui::GetColorU32(colors::over_picture);
    const auto on_screen = [&](double x, double y) {
        return ImVec2(corner.x + float(x) * size.x, corner.y + float(y) * size.y);
    };
    const auto frame = [&](ImVec2 a, ImVec2 b) {
        draw->AddRect(a, b, ground, 0, 4 * scale);
        draw->AddRect(a, b, line, 0, 2 * scale);
    };
    if (r.choosing) {
        if (over) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeNWSE);
        if (over && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) r.from = at;
        const char* text = "Drag a rectangle: only there the picture is refined. Esc ends";
        const ImVec2 extent = ImGui::CalcTextSize(text);
        const ImVec2 a(corner.x + (size.x - extent.x) / 2, corner.y + 24 * scale);
        draw->AddRectFilled({a.x - 6 * scale, a.y - 4 * scale},
                            {a.x + extent.x + 6 * scale, a.y + extent.y + 4 * scale}, ground, 3 * scale);
        draw->AddText(a, ImGui::GetColorU32(ImGuiCol_Text), text);
        e.mark("region.hint", a);
        if (!r.from) return true;
        const glm::dvec2 lower = glm::min(*r.from, at), upper = glm::max(*r.from, at);
        frame(on_screen(lower.x, lower.y), on_screen(upper.x, upper.y));
        if (ImGui::IsMouseDown(ImGuiMouseButton_Left)) return true;
        constexpr double least = 0.01; // of the picture: less was a click
        r.from.reset();
        if (upper.x - lower.x < least || upper.y - lower.y < least) return true;
        r.area = glm::vec4(lower.x, upper.x, lower.y, upper.y);
        r.choosing = false;
        r.document = e.document();
        r.camera = e.camera();
        return true;
    }
    const ImVec2 lower = on_screen(r.area->x, r.area->z), upper = on_screen(r.area->y, r.area->w);
    frame(lower, upper);
    // By bounds: a button would take clicks from the handles. Inside the frame at its upper right.
    const float side = 18 * scale;
    const ImVec2 a(upper.x - side, lower.y), b(upper.x, lower.y + side);
    const bool on_close = over && ImGui::IsMouseHoveringRect(a, b);
    draw->AddRectFilled(a, b, on_close ? line : ground);
    const float in = 5 * scale;
    const ImU32 cross = ImGui::GetColorU32(ImGuiCol_Text);
    draw->AddLine({a.x + in, a.y + in}, {b.x - in, b.y - in}, cross, 2 * scale);
    draw->AddLine({a.x + in, b.y - in}, {b.x - in, a.y + in}, cross, 2 * scale);
    e.mark("region.close", a, b);
    e.mark("region", lower, upper);
    if (!on_close) return false;
    ImGui::SetTooltip("Refine the whole picture again (Esc)");
    if (ImGui::IsMouseClicked(ImGuiMouseButton_Left)) r.end();
    return true;
}

} // namespace restage::editor

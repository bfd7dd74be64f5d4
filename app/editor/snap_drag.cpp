// SPDX-License-Identifier: Apache-2.0
#include "snap_drag.hpp"

#include "drag.hpp"
#include "panel_context.hpp"
#include "theme.hpp"
#include "viewport.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <string>
#include <utility>

namespace restage::editor {

namespace {

constexpr float attraction = 12; // of corners and walls [pixel at scale 1]
using Kind = query::SnapHint::Kind;

std::string text_of(const query::SnapHint& hint, float grid) {
    switch (hint.kind) {
        case Kind::grid:
            return fmt::format("grid {:.4g}", grid);
        case Kind::vertex:
            return "corner of " + hint.name;
        case Kind::surface:
            return "on " + hint.name;
        case Kind::wall:
            return "against " + hint.name;
    }
    return "";
}

} // namespace

void begin_snapping(DocumentContext& e, Drag& drag, const glm::dvec3& grabbed, const query::ViewRay& mouse) {
    drag.snapping.reset();
    if (!e.preferences.snap_to.any() || drag.start.empty()) return;
    drag.snapping = std::make_shared<Snapping>(
        Snapping{query::Snapping(e.scene(), drag.thing(), drag.dragged(), grabbed, mouse, e.up()), {}});
}

glm::dvec3 snapped(PanelContext& e, Drag& drag, const glm::dvec3& by, const query::ViewRay& mouse,
                   const std::optional<glm::dvec3>& axis) {
    if (!drag.snapping) return by;
    drag.snapping->hints.clear();
    if (ImGui::GetIO().KeyCtrl || ImGui::GetIO().KeyAlt) return by;
    const SnapTo& to = e.preferences.snap_to;
    auto now =
        drag.snapping->query.snap(e.scene(), e.camera(), e.film_aspect(), {to.grid, to.vertex, to.surface, to.wall},
                                  {.by = by,
                                   .mouse = mouse,
                                   .axis = axis,
                                   .radius = double(attraction * ImGui::GetStyle().FontScaleMain / e.viewport.size.y),
                                   .grid = double(e.view.snap_move)});
    drag.snapping->hints = std::move(now.hints);
    return now.by;
}

void draw_snapping(PanelContext& e, const Drag& drag) {
    if (!drag.active || !drag.snapping || drag.snapping->hints.empty()) return;
    const float scale = ImGui::GetStyle().FontScaleMain;
    const Viewport& v = e.viewport;
    const double reach = e.selection.bounds(e.scene()).radius();
    const int up = std::abs(e.up().x) > 0.5 ? 0 : std::abs(e.up().y) > 0.5 ? 1 : 2;
    glm::dvec3 across[2] = {glm::dvec3(0), glm::dvec3(0)};
    across[0][(up + 1) % 3] = across[1][(up + 2) % 3] = 1;
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->PushClipRect(v.corner, {v.corner.x + v.size.x, v.corner.y + v.size.y}, true);
    const ImU32 ground = ImGui::GetColorU32(colors::over_picture), line = ImGui::GetColorU32(colors::hover);
    const auto segment = [&](const glm::dvec3& from, const glm::dvec3& to) {
        const auto a = v.on_screen(e, from), b = v.on_screen(e, to);
        if (!a || !b) return;
        draw->AddLine(*a, *b, ground, 4 * scale);
        draw->AddLine(*a, *b, line, 2 * scale);
    };
    float below = 14 * scale; // of the next label, if several are at one place
    for (const query::SnapHint& hint : drag.snapping->hints) {
        if (hint.kind == Kind::wall) {
            segment(hint.at - hint.along * (1.5 * reach), hint.at + hint.along * (1.5 * reach));
        } else if (hint.kind != Kind::vertex) {
            for (const glm::dvec3& axis : across)
                segment(hint.at - axis * (0.4 * reach), hint.at + axis * (0.4 * reach));
        }
        const auto at = v.on_screen(e, hint.at);
        if (!at) continue;
        draw->AddCircleFilled(*at, 6 * scale, ground);
        draw->AddCircleFilled(*at, 4 * scale, line);
        if (hint.kind == Kind::vertex) draw->AddCircle(*at, 10 * scale, line, 0, 2 * scale);
        const std::string text = text_of(hint, e.view.snap_move);
        below += picture_label(e, {at->x, at->y + below}, text, "snap." + text);
    }
    draw->PopClipRect();
}

void snap_button(PanelUi& e) {
    SnapTo& to = e.preferences.snap_to;
    const bool on = to.any();
    if (on) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_HeaderActive));
    if (ImGui::Button("Snap")) ImGui::OpenPopup("snap");
    if (on) ImGui::PopStyleColor();
    tip("What dragged things snap to");
    e.mark("toolbar.snap");
    if (!ImGui::BeginPopup("snap")) return;
    ImGui::TextColored(colors::dim, "What dragged things snap to; Ctrl: to nothing");
    const auto row = [&](const char* label, const char* tooltip, bool& value, const char* mark) {
        ImGui::Checkbox(label, &value);
        tip(tooltip);
        e.mark(mark);
    };
    row("Grid", "The middle of the underside, in steps of Move (see Steps)", to.grid, "snap.grid");
    row("Corners", "The corner nearest to where it is held, onto corners of other things", to.vertex, "snap.vertex");
    row("Surfaces", "It stands on what is under the mouse: a table, a shelf", to.surface, "snap.surface");
    row("Walls", "Its outermost side, against upright surfaces along the world's axes", to.wall, "snap.wall");
    ImGui::EndPopup();
}

} // namespace restage::editor

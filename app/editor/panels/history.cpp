// SPDX-License-Identifier: Apache-2.0
// History: every change in order; a click goes there. Says which state is the saved one.
#include "panels.hpp"

#include "document/session.hpp"
#include "state.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>

namespace restage::editor {

void draw_history(PanelContext& e) {
    const scene::History& history = e.session().history();
    const auto go = [&e](std::size_t position) {
        e.change([position](document::Session& s) {
            while (s.history().position() > position && s.undo()) {
            }
            while (s.history().position() < position && s.redo()) {
            }
        });
    };
    const auto saved = history.clean_position();
    const auto row = [&](std::size_t position, const std::string& label) {
        const bool undone = position > history.position(), current = position == history.position();
        if (undone) ImGui::PushStyleColor(ImGuiCol_Text, colors::dim);
        if (ImGui::Selectable(fmt::format("{}##{}", label, position).c_str(), current)) go(position);
        if (undone) ImGui::PopStyleColor();
        e.mark(fmt::format("history.{}", position));
        if (current && ImGui::IsWindowAppearing()) ImGui::SetScrollHereY();
        if (saved == position && position > 0) {
            ImGui::SameLine();
            ImGui::TextColored(colors::good, "saved");
        }
    };
    row(0, e.session().path().empty() ? "New scene" : "Opened");
    ImGuiListClipper clipper;
    clipper.Begin(int(history.size()));
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
            row(std::size_t(i) + 1, history.label(std::size_t(i)));
    if (history.size() == 0)
        empty_note("Nothing has been changed yet. Every change is listed here, and a click goes back to it.");
    // The newest is seen when it comes.
    if (e.panel_state->history_seen != history.position() && history.position() == history.size())
        ImGui::SetScrollHereY(1);
    e.panel_state->history_seen = history.position();
}

} // namespace restage::editor

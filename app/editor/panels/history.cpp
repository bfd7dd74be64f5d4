// SPDX-License-Identifier: Apache-2.0
// History: every change in order; a click goes to that state. Marks the saved state.
#include "panels.hpp"

#include "document/session.hpp"
#include "state.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>

namespace restage::editor {

void draw_history(EditContext& e) {
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
        if (saved == position && (position > 0 || history.dropped() > 0)) { // row 0 otherwise names the origin
            ImGui::SameLine();
            ImGui::TextColored(colors::good, "saved");
            e.mark("history.saved");
        }
    };
    // Its size and limit.
    constexpr double mib = 1 << 20;
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s",
                        fmt::format("{} steps, {:.3g} of", history.size(), double(history.bytes()) / mib).c_str());
    e.mark("history.bytes");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(6 * ImGui::GetFontSize());
    int& typed = e.panel_state->history_mib;
    if (typed == 0) typed = e.preferences.history_mib;
    ImGui::InputInt("MiB##history_mib", &typed, 0, 0);
    if (ImGui::IsItemDeactivatedAfterEdit()) { // on Enter, Tab or a click elsewhere; not after each digit
        e.preferences.history_mib = std::clamp(typed, 16, 65536);
        e.change([bytes = std::size_t(e.preferences.history_mib) << 20](document::Session& s) {
            s.set_history_budget(bytes);
        });
    }
    if (!ImGui::IsItemActive()) typed = e.preferences.history_mib;
    tip("Memory limit for undo; beyond it the oldest steps are dropped. Geometry and pictures count once");
    e.mark("history.budget");
    if (history.dropped() > 0)
        ImGui::TextDisabled(
            "%s", fmt::format("{} older steps were dropped: they can no longer be undone", history.dropped()).c_str());
    row(0, history.dropped() > 0 ? "The oldest remaining state" : e.session().path().empty() ? "New scene" : "Opened");
    ImGuiListClipper clipper;
    clipper.Begin(int(history.size()));
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
            row(std::size_t(i) + 1, history.label(std::size_t(i)));
    if (history.size() == 0)
        empty_note("Nothing has been changed yet. Every change is listed here, and a click goes back to it.");
    // Scrolls to a new step.
    if (e.panel_state->history_seen != history.position() && history.position() == history.size())
        ImGui::SetScrollHereY(1);
    e.panel_state->history_seen = history.position();
}

} // namespace restage::editor

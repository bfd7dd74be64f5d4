// SPDX-License-Identifier: Apache-2.0
// The panels that only show: import report, plugins, log; and the history, where a click goes back.
#include "panels.hpp"

#include "theme.hpp"

#include <fmt/format.h>
#include <imgui.h>

namespace restage::editor {

void draw_history(Editor& e) {
    const scene::History& history = e.session().history();
    const auto go = [&e](std::size_t position) {
        e.later([&e, position] {
            session::Session& s = e.session_for_changes();
            while (s.history().position() > position && s.undo()) {
            }
            while (s.history().position() < position && s.redo()) {
            }
        });
    };
    if (ImGui::Selectable("Opened", history.position() == 0)) go(0);
    for (std::size_t i = 0; i < history.size(); ++i) {
        const bool undone = i >= history.position();
        if (undone) ImGui::PushStyleColor(ImGuiCol_Text, colors::dim);
        if (ImGui::Selectable(fmt::format("{}##{}", history.label(i), i).c_str(), i + 1 == history.position()))
            go(i + 1);
        if (undone) ImGui::PopStyleColor();
    }
}

void draw_import_report(Editor& e) {
    const io::Report& report = e.session().report();
    if (report.entries.empty()) {
        ImGui::TextDisabled(e.session().path().empty() ? "Nothing was imported." : "Everything was kept.");
        return;
    }
    ImGui::Text("%zu kept, %zu approximated, %zu dropped", report.count(RESTAGE_KEPT),
                report.count(RESTAGE_APPROXIMATED), report.count(RESTAGE_DROPPED));
    ImGui::Separator();
    for (const io::ReportEntry& entry : report.entries) {
        if (entry.fate == RESTAGE_KEPT) continue;
        const ImVec4 color = entry.fate == RESTAGE_DROPPED ? colors::error : colors::warning;
        ImGui::PushStyleColor(ImGuiCol_Text, color);
        ImGui::TextUnformatted(io::to_string(entry.fate));
        ImGui::PopStyleColor();
        ImGui::SameLine();
        ImGui::TextWrapped("%s: %s", entry.what.c_str(), entry.note.c_str());
        if (!entry.file.empty()) ImGui::SetItemTooltip("%s:%u", entry.file.c_str(), entry.line);
    }
}

void draw_plugins(Editor& e) {
    for (const plugin::Entry* entry : e.registry().entries()) {
        const bool loaded = entry->state == plugin::State::loaded;
        ImGui::TextColored(loaded ? colors::good : colors::error, "%s", loaded ? "loaded" : "refused");
        ImGui::SameLine();
        ImGui::Text("%s %s", entry->name().c_str(), entry->manifest.version.c_str());
        ImGui::SetItemTooltip("%s", entry->folder.string().c_str());
        if (!loaded) ImGui::TextWrapped("    %s", entry->reason.c_str());
    }
}

void draw_log(Editor& e) {
    for (const LogLine& line : e.notices.lines()) {
        const ImVec4 color = line.level == LogLevel::error     ? colors::error
                             : line.level == LogLevel::warning ? colors::warning
                                                               : ImGui::GetStyleColorVec4(ImGuiCol_Text);
        ImGui::TextDisabled("%7.1f", line.time);
        ImGui::SameLine();
        ImGui::PushStyleColor(ImGuiCol_Text, color);
        ImGui::TextWrapped("%s", line.text.c_str());
        ImGui::PopStyleColor();
    }
    if (ImGui::GetScrollY() >= ImGui::GetScrollMaxY()) ImGui::SetScrollHereY(1);
}

} // namespace restage::editor

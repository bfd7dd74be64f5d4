// SPDX-License-Identifier: Apache-2.0
// Log: messages of the program.
#include "panels.hpp"

#include "state.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <misc/cpp/imgui_stdlib.h>

namespace restage::editor {

void draw_log(PanelUi& e) {
    LogState& state = e.panel_state->log;
    const auto filter = [&e](const char* label, bool& on, const char* tooltip, const char* mark, bool first = false) {
        if (!first) flow(check_width(label));
        ImGui::Checkbox(label, &on);
        tip(tooltip);
        e.mark(mark);
    };
    filter("Notes", state.info, "Completed actions", "log.info", true);
    filter("Warnings", state.warnings, "Actions completed differently than requested", "log.warnings");
    filter("Errors", state.errors, "Failed actions", "log.errors");
    filter("Details", state.details, "Internal details, for bug reports", "log.details");
    const float width = 110 * ImGui::GetStyle().FontScaleMain;
    flow(width);
    ImGui::SetNextItemWidth(width);
    ImGui::InputTextWithHint("##search", "Search", &state.search);
    e.mark("log.search");
    const auto lines = e.notices.lines();
    const std::size_t total = e.notices.count(), first = total - lines.size();
    std::vector<const LogLine*> shown;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const LogLine& line = lines[i];
        const bool wanted = line.level == LogLevel::debug     ? state.details
                            : line.level == LogLevel::error   ? state.errors
                            : line.level == LogLevel::warning ? state.warnings
                                                              : state.info;
        if (first + i >= state.cleared && wanted && contains_word(line.text, state.search)) shown.push_back(&line);
    }
    if (flow_button("Copy")) {
        std::string text;
        for (const LogLine* line : shown)
            text += fmt::format("{:8.1f} s  {}\n", line->time, line->text);
        ImGui::SetClipboardText(text.c_str());
    }
    tip("Copy the shown lines to the clipboard");
    e.mark("log.copy");
    if (flow_button("Clear")) state.cleared = total;
    tip("Clear this list");
    e.mark("log.clear");
    ImGui::Separator();
    if (shown.empty())
        empty_note(state.cleared == total || lines.empty() ? "No messages yet." : "No messages at these levels yet.");
    if (ImGui::BeginChild("lines")) {
        for (const LogLine* line : shown) {
            ImGui::TextDisabled("%7.1f s", line->time);
            ImGui::SameLine();
            ImGui::PushStyleColor(ImGuiCol_Text, line->level == LogLevel::error ? colors::error
                                                 : line->level == LogLevel::warning
                                                     ? colors::warning
                                                     : ImGui::GetStyleColorVec4(ImGuiCol_Text));
            ImGui::TextWrapped("%s", line->text.c_str());
            ImGui::PopStyleColor();
        }
        if (std::exchange(state.seen, total) != total) ImGui::SetScrollHereY(1);
    }
    ImGui::EndChild();
}

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
// Plugins: what is loaded, from where, and why not. Log: what happened.
#include "panels.hpp"

#include "state.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <misc/cpp/imgui_stdlib.h>

namespace restage::editor {

void draw_plugins(Editor& e) {
    const auto entries = e.registry().entries();
    std::size_t refused = 0;
    for (const plugin::Entry* entry : entries)
        refused += entry->state == plugin::State::refused;
    ImGui::TextDisabled("%zu loaded, %zu refused", entries.size() - refused, refused);
    if (entries.empty()) {
        empty_note(
            "No plugins were found: nothing can be opened or shaded. They are looked for beside the program, in the "
            "folder "
            "for a user's own, and in those that RESTAGE_PLUGIN_PATH names.");
        return;
    }
    if (!ImGui::BeginTable("plugins", 4,
                           ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_BordersInnerV |
                               ImGuiTableFlags_ScrollY))
        return;
    ImGui::TableSetupScrollFreeze(0, 1);
    ImGui::TableSetupColumn("Plugin", 0, 3);
    ImGui::TableSetupColumn("Kind", 0, 1);
    ImGui::TableSetupColumn("Version", 0, 1);
    ImGui::TableSetupColumn("Folder, or why it was refused", 0, 6);
    ImGui::TableHeadersRow();
    for (const bool show_refused : {true, false}) // what went wrong comes first
        for (const plugin::Entry* entry : entries) {
            if ((entry->state == plugin::State::refused) != show_refused) continue;
            ImGui::PushID(entry);
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            if (show_refused)
                ImGui::TextColored(colors::error, "%s", entry->name().c_str());
            else
                ImGui::TextUnformatted(entry->name().c_str());
            ImGui::TableNextColumn();
            if (!entry->manifest.id.empty()) ImGui::TextDisabled("%s", plugin::to_string(entry->manifest.kind));
            ImGui::TableNextColumn();
            ImGui::TextDisabled("%s", entry->manifest.version.c_str());
            ImGui::TableNextColumn();
            if (show_refused)
                warning_note(entry->reason.c_str());
            else
                ImGui::TextDisabled("%s", entry->folder.string().c_str());
            tip(fmt::format("{}\nClick to copy the folder's path", entry->folder.string()).c_str());
            if (ImGui::IsItemClicked()) {
                ImGui::SetClipboardText(entry->folder.string().c_str());
                e.notices.add(LogLevel::info, "Copied: " + entry->folder.string());
            }
            ImGui::PopID();
        }
    ImGui::EndTable();
}

void draw_log(Editor& e) {
    LogState& state = e.panel_state->log;
    ImGui::Checkbox("Notes", &state.info);
    e.mark("log.info");
    ImGui::SameLine();
    ImGui::Checkbox("Warnings", &state.warnings);
    e.mark("log.warnings");
    ImGui::SameLine();
    ImGui::Checkbox("Errors", &state.errors);
    e.mark("log.errors");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(140 * ImGui::GetStyle().FontScaleMain);
    ImGui::InputTextWithHint("##search", "Search", &state.search);
    e.mark("log.search");
    const auto lines = e.notices.lines();
    const std::size_t total = e.notices.count(), first = total - lines.size();
    std::vector<const LogLine*> shown;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const LogLine& line = lines[i];
        const bool wanted = line.level == LogLevel::error     ? state.errors
                            : line.level == LogLevel::warning ? state.warnings
                                                              : state.info;
        if (first + i >= state.cleared && wanted && contains_word(line.text, state.search)) shown.push_back(&line);
    }
    ImGui::SameLine();
    if (ImGui::Button("Copy")) {
        std::string text;
        for (const LogLine* line : shown)
            text += fmt::format("{:8.1f} s  {}\n", line->time, line->text);
        ImGui::SetClipboardText(text.c_str());
    }
    tip("Copy the lines that are shown to the clipboard");
    e.mark("log.copy");
    ImGui::SameLine();
    if (ImGui::Button("Clear")) state.cleared = total;
    e.mark("log.clear");
    ImGui::Separator();
    if (shown.empty())
        empty_note(state.cleared == total || lines.empty() ? "Nothing has happened yet." : "No line fits the filter.");
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

// SPDX-License-Identifier: Apache-2.0
// Plugins: loaded ones and their folders, refused ones and the reasons; and checks whether they meet their contract.
#include "panels.hpp"

#include "base/file.hpp"
#include "check/report.hpp"
#include "check/supervise.hpp"
#include "files.hpp"
#include "panel_context.hpp"
#include "plugin/registry.hpp"
#include "state.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>

namespace restage::editor {

namespace {

// "restage check" of this one, while the user keeps working.
void start_check(PanelUi& e, const plugin::Entry& entry) {
    e.files().jobs.start(
        {.title = "Checking " + entry.name()},
        [name = entry.name(), folder = entry.folder](BackgroundJob& job) -> std::function<void(PanelContext&)> {
            std::atomic<bool> cancel{false};
            double steps = 0;
            const auto ran = [&]() -> Result<check::PluginReport> {
                check::Supervision s;
                RESTAGE_TRY(s.program, executable_path());
                s.folder = folder;
                s.options.quick = true;
                s.cancel = &cancel;
                s.on_begin = [&](const std::string& step, const std::string&) {
                    cancel = !job.report(std::min(0.95, steps++ / 20), step);
                };
                return check::check_plugin(s);
            }();
            if (cancel) return {};
            return [name, ran](PanelUi& editor) {
                if (!ran) return editor.notices.add(LogLevel::error, ran.error().message);
                const bool passed = ran->passed();
                editor.notices.add(passed ? LogLevel::info : LogLevel::error, name + ": " + check::verdict_line(*ran));
                editor.panel_state->checks[name] = *ran;
            };
        });
}

void check_result(const check::PluginReport& report) {
    if (report.passed()) {
        ImGui::TextDisabled("%s", check::verdict_line(report).c_str());
        return;
    }
    for (const check::StepResult& step : report.steps)
        if (step.verdict == check::Verdict::fail)
            warning_note(
                fmt::format("{}: {}{}{}", step.step, step.text, step.cause.empty() ? "" : "\n", step.cause).c_str());
}

void buttons(DocumentContext& e, const plugin::Entry& entry) {
    if (entry.quarantined) {
        if (ImGui::SmallButton("Enable")) {
            const auto released = e.registry().quarantine().release(entry.manifest.id);
            e.notices.add(released ? LogLevel::info : LogLevel::error,
                          released ? entry.name() + " will be loaded at the next start" : released.error().message);
        }
        tip("It crashed the program. Load it again at the next start");
        e.mark("plugins.enable." + entry.name());
    }
    if (entry.manifest.id.empty()) return;
    if (ImGui::SmallButton("Check")) start_check(e, entry);
    tip("Test whether it meets its contract, in a separate process: samples against density and value, energy, "
        "reciprocity, non-finite numbers. `restage check` tests more");
    e.mark("plugins.check." + entry.name());
}

} // namespace

void draw_plugins(DocumentContext& e) {
    const auto entries = e.registry().entries();
    std::size_t refused = 0;
    for (const plugin::Entry* entry : entries)
        refused += entry->state == plugin::State::refused;
    ImGui::TextDisabled("%zu loaded, %zu refused", entries.size() - refused, refused);
    if (entries.empty()) {
        empty_note(
            "No plugins were found: nothing can be opened or rendered. Searched: next to the program, in the "
            "user's plugin folder, and in the folders of RESTAGE_PLUGIN_PATH.");
        return;
    }
    if (!ImGui::BeginTable("plugins", 5,
                           ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_BordersInnerV |
                               ImGuiTableFlags_ScrollY))
        return;
    ImGui::TableSetupScrollFreeze(0, 1);
    ImGui::TableSetupColumn("Plugin", 0, 3);
    ImGui::TableSetupColumn("Kind", 0, 1);
    ImGui::TableSetupColumn("Version", 0, 1);
    ImGui::TableSetupColumn("", ImGuiTableColumnFlags_WidthFixed);
    ImGui::TableSetupColumn("Folder, or error", 0, 6);
    ImGui::TableHeadersRow();
    const auto wrong = [&](const plugin::Entry& entry) {
        return entry.state == plugin::State::refused || !entry.trouble.empty();
    };
    for (const bool show_wrong : {true, false}) // failures first
        for (const plugin::Entry* entry : entries) {
            if (wrong(*entry) != show_wrong) continue;
            ImGui::PushID(entry);
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            if (show_wrong)
                ImGui::TextColored(colors::error, "%s", entry->name().c_str());
            else
                ImGui::TextAligned(0, -FLT_MIN, "%s", entry->name().c_str());
            ImGui::PushStyleColor(ImGuiCol_Text, colors::dim);
            ImGui::TableNextColumn();
            if (!entry->manifest.id.empty())
                ImGui::TextAligned(0, -FLT_MIN, "%s", choice_label(entry->manifest.kind()).c_str());
            ImGui::TableNextColumn();
            ImGui::TextAligned(0, -FLT_MIN, "%s", entry->manifest.version.c_str());
            ImGui::PopStyleColor();
            ImGui::TableNextColumn();
            buttons(e, *entry);
            ImGui::TableNextColumn();
            if (!entry->trouble.empty())
                warning_note(("The previous version is in use. " + entry->trouble).c_str());
            else if (show_wrong)
                warning_note(entry->reason.c_str());
            else
                ImGui::TextAligned(0, -FLT_MIN, "%s", entry->folder.string().c_str());
            tip(fmt::format("{}\nClick to copy the folder's path", entry->folder.string()).c_str());
            if (ImGui::IsItemClicked()) {
                ImGui::SetClipboardText(entry->folder.string().c_str());
                e.notices.add(LogLevel::info, "Copied: " + entry->folder.string());
            }
            if (const auto checked = e.panel_state->checks.find(entry->name()); checked != e.panel_state->checks.end())
                check_result(checked->second);
            ImGui::PopID();
        }
    ImGui::EndTable();
}

} // namespace restage::editor

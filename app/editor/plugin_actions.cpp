// SPDX-License-Identifier: Apache-2.0
#include "plugin_actions.hpp"

#include "document/actions.hpp"
#include "files.hpp"
#include "panel_context.hpp"
#include "panels/state.hpp"
#include "param_widget.hpp"
#include "widgets.hpp"

#include <imgui.h>
#include <algorithm>

namespace restage::editor {

namespace {

void tell(SelectContext& e, const std::string& label, const io::Report& report) {
    for (const io::ReportEntry& line : report.entries) {
        const bool kept = line.fate == io::Fate::kept;
        e.notices.add(kept ? LogLevel::info : LogLevel::warning,
                      label + ": " + line.what + (line.note.empty() ? "" : ": " + line.note));
    }
}

// [main] The document may have changed meanwhile, or be a different one.
void take(SelectContext& e, std::uint64_t document, io::ActionResult result) {
    if (e.document() != document) {
        e.notices.add(LogLevel::info, result.edit.label + ": its document is no longer open");
        return;
    }
    e.change([&e, result = std::move(result)](document::Session& session) mutable {
        const std::string label = result.edit.label;
        auto done = document::apply_action(session, std::move(result));
        if (!done) return e.notices.add(LogLevel::error, done.error().message);
        tell(e, label, done->report);
        if (!done->selection.empty()) e.selection.set(done->selection);
    });
}

} // namespace

std::string why_not_now(const SelectContext& e, const model::Action& action) {
    if (const auto running = e.panel_state->plugins.running.lock()) return *running + " still runs";
    if (action.needs_selection && e.selection.instances().empty()) return "Select objects first";
    return "";
}

void start_action(SelectContext& e, const plugin::ActionEntry& entry, scene::ParamSet values) {
    if (const std::string why = why_not_now(e, *entry.table); !why.empty())
        return e.notices.add(LogLevel::info, entry.table->label + ": " + why);
    const auto running = std::make_shared<const std::string>(entry.table->label);
    e.panel_state->plugins.running = running;
    io::ActionRun run{.selection = e.selection.instances(), .values = std::move(values), .progress = {}};
    e.files().jobs.start(
        {.title = entry.table->label},
        [entry, running, run = std::move(run), scene = e.scene(), document = e.document(),
         &registry = e.registry()](BackgroundJob& job) mutable -> std::function<void(PanelContext&)> {
            run.progress = [&job](float done, std::string_view what) { return job.report(double(done), what); };
            auto result = io::run_action(scene, registry, entry, run);
            return [document, running,
                    result = std::make_shared<Result<io::ActionResult>>(std::move(result))](SelectContext& now) {
                if (*result)
                    take(now, document, std::move(**result));
                else if (!result->error().cancelled())
                    now.notices.add(LogLevel::error, result->error().message);
            };
        });
}

void ask_for_action(SelectContext& e, const plugin::ActionEntry& entry) {
    if (entry.table->params.empty()) return start_action(e, entry, {});
    e.show_modal(entry.table->label, [id = entry.table->id, height = 0.f](SelectContext& editor) mutable {
        const auto found = document::find_action(editor.registry(), id); // it may have been reloaded
        if (!found) return false;
        const model::Action& action = *found->table;
        scene::ParamSet& values = editor.panel_state->plugins.asked[id];
        dialog_width(400);
        ImGui::TextWrapped("%s", action.tooltip.c_str());
        ImGui::Spacing();
        scene::ParamSet fitting; // may have other values of an earlier version
        const auto row = [&](const model::Param& line) {
            const scene::Value* set = values.find(line.id);
            if (set && !misfit(line, *set).empty()) set = nullptr;
            const ParamAsk ask = param_widget(editor, line, set ? *set : scene::default_value(line), set != nullptr,
                                              "action." + id + "." + line.id);
            if (set) fitting.set(line.id, *set);
            if (ask.reset) fitting.remove(line.id);
            if (ask.value) fitting.set(line.id, *ask.value);
        };
        // In a small window the rows scroll, and the buttons stay visible.
        const float line_height = ImGui::GetFrameHeightWithSpacing();
        const float above = ImGui::GetCursorScreenPos().y - ImGui::GetWindowPos().y;
        const float room =
            std::max(ImGui::GetMainViewport()->WorkSize.y * 0.96f - above - 2 * line_height, 3 * line_height);
        const bool scrolls = height > room;
        if (scrolls) ImGui::BeginChild("rows", {0, room}); // rows are drawn even if it is clipped
        const float top = ImGui::GetCursorPosY();
        bool advanced = false, unfolded = false;
        for (const model::Param& line : action.params)
            if (line.advanced)
                advanced = true;
            else
                row(line);
        if (advanced) {
            unfolded = ImGui::TreeNodeEx("Advanced", ImGuiTreeNodeFlags_SpanAvailWidth);
            editor.mark("action." + id + ".advanced");
        }
        for (const model::Param& line : action.params) {
            if (!line.advanced) continue;
            if (unfolded)
                row(line);
            else if (const scene::Value* set = values.find(line.id); set && misfit(line, *set).empty())
                fitting.set(line.id, *set);
        }
        if (unfolded) ImGui::TreePop();
        height = ImGui::GetCursorPosY() - top;
        if (scrolls) ImGui::EndChild();
        values = fitting;
        ImGui::Spacing();
        bool stay = true;
        const std::string why = why_not_now(editor, action);
        ImGui::BeginDisabled(!why.empty());
        if (ImGui::Button("Run")) {
            start_action(editor, *found, values);
            stay = false;
        }
        ImGui::EndDisabled();
        tip(why.empty() ? "In the background; its changes are one undo step" : why.c_str());
        editor.mark("action.run");
        ImGui::SameLine();
        if (ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGuiKey_Escape, false)) stay = false;
        editor.mark("action.cancel");
        return stay;
    });
}

void tools_menu(SelectContext& e) {
    const auto catalogue = e.registry().catalogue();
    if (catalogue->actions.empty()) return;
    const bool shown = ImGui::BeginMenu("Tools");
    e.mark("menu.tools");
    if (!shown) return;
    for (const plugin::ActionEntry& entry : catalogue->actions) {
        const model::Action& action = *entry.table;
        const std::string why = why_not_now(e, action);
        const std::string label = action.label + (action.params.empty() ? "" : "...");
        if (ImGui::MenuItem((label + "##" + action.id).c_str(), nullptr, false, why.empty())) ask_for_action(e, entry);
        tip((action.tooltip + (why.empty() ? "" : "\n" + why)).c_str());
        e.mark("tools." + action.id);
    }
    ImGui::EndMenu();
}

} // namespace restage::editor

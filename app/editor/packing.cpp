// SPDX-License-Identifier: Apache-2.0
#include "packing.hpp"

#include "document/pack.hpp"
#include "document/session.hpp"
#include "file_browser.hpp"
#include "files.hpp"
#include "panel_context.hpp"
#include "saving.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <filesystem>
#include <string>
#include <utility>

namespace restage::editor {

namespace fs = std::filesystem;

namespace {

void show_problems(PanelContext& e, const document::Packed& packed) {
    e.show_modal("Packed, but not complete", [packed](PanelContext& editor) {
        dialog_width(520);
        ImGui::TextWrapped("%s was written. On another machine it will lack this:", packed.project.string().c_str());
        ImGui::BeginChild("problems", {0, 200 * ImGui::GetStyle().FontScaleMain}, ImGuiChildFlags_Borders);
        for (const std::string& problem : packed.problems)
            ImGui::TextWrapped("%s", problem.c_str());
        ImGui::EndChild();
        const bool close = ImGui::Button("Close") || ImGui::IsKeyPressed(ImGuiKey_Escape, false) ||
                           ImGui::IsKeyPressed(ImGuiKey_Enter, false);
        editor.mark("packed.close");
        return !close;
    });
}

void start_packing(PanelContext& e, const fs::path& out) {
    e.files().jobs.start(
        {.title = "Packing " + out.filename().string()},
        [out, project = e.session().recovery_text({}), isolate = e.options().isolate,
         &registry = e.registry()](BackgroundJob& job) -> std::function<void(PanelContext&)> {
            document::ReadOptions reading;
            reading.progress = [&job](float done, std::string_view what) { return job.report(double(done), what); };
            reading.isolate = isolate;
            auto packed = document::pack_project(project, out, registry, reading);
            if (!packed)
                return [message = packed.error().message, out](PanelContext& editor) {
                    show_failure(editor, {.title = "Not packed",
                                          .reason = message,
                                          .again = [&editor, out] { start_packing(editor, out); },
                                          .elsewhere = [&editor] { pack_dialog(editor); }});
                };
            return [done = std::move(*packed)](PanelContext& editor) {
                editor.notices.add(LogLevel::info,
                                   fmt::format("Packed: {} with {} file{}, {:.1f} MB", done.project.string(),
                                               done.files, done.files == 1 ? "" : "s", double(done.bytes) * 1e-6));
                if (!done.problems.empty()) show_problems(editor, done);
            };
        });
}

} // namespace

void pack_dialog(PanelContext& e) {
    const fs::path path(e.session().path());
    browse(e, {.title = "Pack project",
               .save = true,
               .filters = {{"Zip files", {"zip"}}, {"All files", {}}},
               .start = path.empty() ? fs::path() : path.parent_path(),
               .name = (path.empty() ? "untitled" : path.stem().string()) + " packed.zip",
               .done = [](PanelContext& editor, const fs::path& out) { start_packing(editor, out); },
               .details =
                   [](PanelContext& editor, const fs::path& name, bool) {
                       ImGui::TextColored(colors::dim, "%s",
                                          document::is_packed(name) ? "One file, with everything the scene needs"
                                                                    : "A new folder, with everything the scene needs");
                       editor.mark("pack.kind");
                   }});
}

} // namespace restage::editor

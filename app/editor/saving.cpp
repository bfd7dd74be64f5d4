// SPDX-License-Identifier: Apache-2.0
#include "saving.hpp"

#include "document/session.hpp"
#include "editor.hpp"
#include "file_browser.hpp"
#include "files.hpp"
#include "importing.hpp"
#include "opening.hpp"
#include "plugin/registry.hpp"
#include "scene/studio.hpp"
#include "scene_pictures.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <set>

namespace restage::editor {

namespace fs = std::filesystem;

// First all files that can be opened, then each importer's, then all files.
std::vector<FileFilter> scene_filters(const plugin::Registry& registry, bool projects) {
    std::vector<FileFilter> filters;
    FileFilter all{projects ? "Scenes and projects" : "Everything known", {}};
    if (projects) {
        filters.push_back({"Restage projects", {"restage", "zip"}});
        all.extensions = {"restage", "zip"};
    }
    for (const auto& importer : registry.importers()) {
        filters.push_back({importer.table->label, importer.table->extensions});
        all.extensions.insert(all.extensions.end(), filters.back().extensions.begin(), filters.back().extensions.end());
    }
    filters.insert(filters.begin(), all);
    filters.push_back({"All files", {}});
    return filters;
}

namespace {

std::string project_name(const PanelContext& e) {
    const fs::path path(e.session().path());
    return (path.empty() ? "untitled" : path.stem().string()) + std::string(document::project_extension);
}

fs::path document_folder(const PanelContext& e) {
    const fs::path path(e.session().path());
    return path.empty() ? fs::path() : path.parent_path();
}

void save_to(Editor& e, const fs::path& path, const Then& then) {
    if (const auto saved = e.session_for_changes().save_project(path.string()); !saved) {
        show_failure(e, {.title = "Not saved",
                         .reason = saved.error().message,
                         .again = [&e, path, then] { save_to(e, path, then); },
                         .elsewhere = [&e, then] { save_as(e, then); }});
        return;
    }
    e.files().recent.add_file(path);
    keep_scene_picture(e);
    e.notices.add(LogLevel::info, "Saved " + path.filename().string());
    if (then) then(e);
}

} // namespace

void show_failure(PanelContext& e, WriteFailure failure) {
    e.log().error(failure.reason);
    std::string title = failure.title;
    e.show_modal(std::move(title), [failure = std::move(failure)](PanelContext& editor) {
        dialog_width(460);
        ImGui::PushStyleColor(ImGuiCol_Text, colors::error);
        ImGui::TextWrapped("%s", failure.reason.c_str());
        ImGui::PopStyleColor();
        ImGui::Spacing();
        const auto choice = [&](const char* label, const char* mark, const std::function<void()>& then) {
            const bool pressed = ImGui::Button(label);
            editor.mark(mark);
            if (pressed) editor.later(then);
            ImGui::SameLine();
            return pressed;
        };
        bool stay = true;
        if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
        if (choice("Save as...", "failure.elsewhere", failure.elsewhere)) stay = false;
        if (choice("Try again", "failure.again", failure.again)) stay = false;
        if (ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGuiKey_Escape, false)) stay = false;
        editor.mark("failure.cancel");
        return stay;
    });
}

void ask_unsaved(Editor& e, const char* doing, Then then) {
    if (!e.session().modified()) {
        then(e);
        return;
    }
    e.show_modal(
        "Unsaved changes",
        [text = fmt::format("{} has unsaved changes. Save them before {}?",
                            e.session().path().empty() ? "The scene" : fs::path(e.session().path()).filename().string(),
                            doing),
         then = std::move(then), &editor = e](PanelContext&) {
            dialog_width(400);
            ImGui::TextWrapped("%s", text.c_str());
            ImGui::Spacing();
            bool stay = true;
            if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
            if (ImGui::Button("Save")) {
                editor.later([&editor, then] { save(editor, then); });
                stay = false;
            }
            editor.mark("unsaved.save");
            ImGui::SameLine();
            if (ImGui::Button("Discard")) {
                editor.later([&editor, then] { then(editor); });
                stay = false;
            }
            editor.mark("unsaved.discard");
            ImGui::SameLine();
            if (ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGuiKey_Escape, false)) stay = false;
            editor.mark("unsaved.cancel");
            return stay;
        });
}

void new_scene(Editor& e) {
    ask_unsaved(e, "starting a new scene", [](Editor& editor) {
        editor.opening().cancel();
        editor.adopt_scene(scene::studio_scene());
    });
}

void open_dialog(Editor& e) {
    browse(e, {.title = "Open",
               .filters = scene_filters(e.registry(), true),
               .start = document_folder(e),
               .done =
                   [&e](PanelContext& editor, const fs::path& path) {
                       ask_unsaved(e, "opening another scene",
                                   [path, options = import_options_for(editor, path)](Editor& now) {
                                       now.open_now({.path = path, .import_options = options});
                                   });
                   },
               .details = import_options_part});
}

namespace {

void add_file(Editor& e, bool link) {
    browse(e, {.title = link ? "Link file" : "Insert file",
               .filters = scene_filters(e.registry(), false),
               .start = document_folder(e),
               .done =
                   [&e, link](PanelContext& editor, const fs::path& path) {
                       e.open_now({.path = path,
                                   .purpose = Opening::Purpose::insert,
                                   .link = link,
                                   .import_options = import_options_for(editor, path)});
                   },
               .details = import_options_part});
}

} // namespace

void insert_dialog(Editor& e) { add_file(e, false); }
void link_dialog(Editor& e) { add_file(e, true); }

void save(Editor& e, Then then) {
    if (document::is_project(e.session().path()))
        save_to(e, e.session().path(), then);
    else
        save_as(e, std::move(then));
}

void save_as(Editor& e, Then then) {
    browse(e, {.title = "Save as",
               .save = true,
               .filters = {{"Restage projects", {"restage"}}, {"All files", {}}},
               .start = document_folder(e),
               .name = project_name(e),
               .extension = std::string(document::project_extension),
               .done = [then = std::move(then), &editor = e](PanelContext&, const fs::path& path) {
                   fs::path place = path;
                   if (!document::is_project(place)) place += document::project_extension;
                   save_to(editor, place, then);
               }});
}

void revert(Editor& e) {
    const fs::path path(e.session().path());
    std::optional<scene::ParamSet> options; // a project has them in its file
    if (!document::is_project(path)) options = e.session().base().options;
    const auto reopen = [path, options](Editor& editor) { editor.open_now({.path = path, .import_options = options}); };
    if (!e.session().modified()) {
        reopen(e);
        return;
    }
    e.show_modal("Revert", [path, reopen, steps = e.session().history().position(), &editor = e](PanelContext&) {
        dialog_width(400);
        ImGui::TextWrapped("Discard all changes since %s was saved?", path.filename().string().c_str());
        empty_note((steps == 1 ? "One step of the history is lost; this cannot be undone."
                               : fmt::format("{} steps of the history are lost; this cannot be undone.", steps))
                       .c_str());
        ImGui::Spacing();
        bool stay = true;
        if (ImGui::Button("Revert")) {
            editor.later([&editor, reopen] { reopen(editor); });
            stay = false;
        }
        editor.mark("revert.revert");
        ImGui::SameLine();
        if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
        if (ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGuiKey_Escape, false)) stay = false;
        editor.mark("revert.cancel");
        return stay;
    });
}

void recent_menu(PanelContext& e) {
    const auto& files = e.files().recent.files();
    if (!ImGui::BeginMenu("Open recent", !files.empty())) {
        e.mark("file.recent");
        return;
    }
    e.mark("file.recent");
    for (std::size_t i = 0; i < files.size(); ++i) {
        const fs::path path(files[i]);
        if (ImGui::MenuItem(fmt::format("{}##{}", path.filename().string(), i).c_str())) e.open(path);
        scene_picture_tip(e, path);
        e.mark("recent." + path.filename().string());
    }
    ImGui::Separator();
    if (ImGui::MenuItem("Forget these")) e.files().recent.clear();
    ImGui::EndMenu();
}

void offer_recovery(Editor& e) {
    auto found =
        std::make_shared<std::vector<document::Recoverable>>(document::find_recoverable(e.files().recovery_folder));
    if (found->empty()) return;
    e.show_modal("Unsaved work was found", [found, &editor = e](PanelContext&) {
        dialog_width(560);
        ImGui::TextWrapped("Restage ended before this was saved. It can be opened as it was.");
        ImGui::Spacing();
        bool stay = true;
        std::size_t gone = found->size();
        const float scale = ImGui::GetStyle().FontScaleMain;
        if (ImGui::BeginTable("found", 4,
                              ImGuiTableFlags_RowBg | ImGuiTableFlags_BordersInnerH | ImGuiTableFlags_SizingFixedFit)) {
            ImGui::TableSetupColumn("Scene", ImGuiTableColumnFlags_WidthStretch);
            ImGui::TableSetupColumn("Written aside", ImGuiTableColumnFlags_WidthFixed, 130 * scale);
            ImGui::TableSetupColumn("Changes", ImGuiTableColumnFlags_WidthFixed, 60 * scale);
            ImGui::TableSetupColumn("");
            ImGui::TableHeadersRow();
            for (std::size_t i = 0; i < found->size(); ++i) {
                const document::Recoverable& what = (*found)[i];
                ImGui::PushID(int(i));
                ImGui::TableNextRow();
                ImGui::TableNextColumn();
                ImGui::AlignTextToFramePadding();
                ImGui::TextUnformatted(what.name.c_str());
                if (!what.base.empty()) ImGui::SetItemTooltip("%s", what.base.c_str());
                ImGui::TableNextColumn();
                ImGui::TextUnformatted(what.time.c_str());
                ImGui::TableNextColumn();
                ImGui::TextUnformatted(what.changes.c_str());
                ImGui::TableNextColumn();
                if (ImGui::Button("Recover")) {
                    stay = false;
                    editor.later([&editor, file = what.file] {
                        ask_unsaved(editor, "recovering another scene", [file](Editor& x) {
                            x.open_now({.path = file, .purpose = Opening::Purpose::recover});
                        });
                    });
                }
                if (i == 0) editor.mark("recovery.recover");
                ImGui::SameLine();
                if (ImGui::Button("Discard")) gone = i;
                if (i == 0) editor.mark("recovery.discard");
                ImGui::PopID();
            }
            ImGui::EndTable();
        }
        if (gone < found->size()) {
            document::discard_recoverable((*found)[gone]);
            found->erase(found->begin() + std::ptrdiff_t(gone));
            stay = stay && !found->empty();
        }
        ImGui::Spacing();
        if (ImGui::Button("Later") || ImGui::IsKeyPressed(ImGuiKey_Escape, false)) stay = false;
        ImGui::SetItemTooltip("It is offered again at the next start");
        editor.mark("recovery.later");
        return stay;
    });
}

} // namespace restage::editor

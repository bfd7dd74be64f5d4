// SPDX-License-Identifier: Apache-2.0
#include "saving.hpp"

#include "editor.hpp"
#include "file_browser.hpp"
#include "files.hpp"
#include "scene/studio.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <set>

namespace restage::editor {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> split(std::string_view list) { // "a|b"
    std::vector<std::string> parts;
    while (!list.empty()) {
        parts.emplace_back(list.substr(0, list.find('|')));
        list.remove_prefix(std::min(list.size(), parts.back().size() + 1));
    }
    return parts;
}

// All that can be opened together first, then each importer's, then every file.
std::vector<FileFilter> scene_filters(const plugin::Registry& registry, bool projects) {
    std::vector<FileFilter> filters;
    FileFilter all{projects ? "Scenes and projects" : "Everything known", {}};
    if (projects) {
        filters.push_back({"Restage projects", {"restage"}});
        all.extensions = {"restage"};
    }
    for (const auto& importer : registry.importers()) {
        filters.push_back({importer.table->label, split(importer.table->extensions)});
        all.extensions.insert(all.extensions.end(), filters.back().extensions.begin(), filters.back().extensions.end());
    }
    filters.insert(filters.begin(), all);
    filters.push_back({"All files", {}});
    return filters;
}

std::string project_name(const Editor& e) {
    const fs::path path(e.session().path());
    return (path.empty() ? "untitled" : path.stem().string()) + std::string(document::project_extension);
}

fs::path document_folder(const Editor& e) {
    const fs::path path(e.session().path());
    return path.empty() ? fs::path() : path.parent_path();
}

void save_to(Editor& e, const fs::path& path, const Then& then) {
    if (const auto saved = e.session_for_changes().save_project(path.string()); !saved) {
        show_failure(e, {.title = "Not saved",
                         .reason = saved.error().message,
                         .again = [path, then](Editor& editor) { save_to(editor, path, then); },
                         .elsewhere = [then](Editor& editor) { save_as(editor, then); }});
        return;
    }
    e.files().recent.add_file(path);
    e.notices.add(LogLevel::info, "Saved " + path.filename().string());
    if (then) then(e);
}

} // namespace

void show_failure(Editor& e, WriteFailure failure) {
    e.log().error(failure.reason);
    std::string title = failure.title;
    e.show_modal(std::move(title), [failure = std::move(failure)](Editor& editor) {
        dialog_width(460);
        ImGui::PushStyleColor(ImGuiCol_Text, colors::error);
        ImGui::TextWrapped("%s", failure.reason.c_str());
        ImGui::PopStyleColor();
        ImGui::Spacing();
        const auto choice = [&](const char* label, const char* mark, const Then& then) {
            const bool pressed = ImGui::Button(label);
            editor.mark(mark);
            if (pressed) editor.later([&editor, then] { then(editor); });
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
        [text = fmt::format("{} has changes that are not saved. Save them before {}?",
                            e.session().path().empty() ? "The scene" : fs::path(e.session().path()).filename().string(),
                            doing),
         then = std::move(then)](Editor& editor) {
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
               .done = [](Editor& editor, const fs::path& path) { editor.open(path); }});
}

void insert_dialog(Editor& e) {
    browse(e, {.title = "Insert file",
               .filters = scene_filters(e.registry(), false),
               .start = document_folder(e),
               .done = [](Editor& editor, const fs::path& path) { editor.insert(path); }});
}

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
               .done = [then = std::move(then)](Editor& editor, const fs::path& path) {
                   fs::path place = path;
                   if (!document::is_project(place)) place += document::project_extension;
                   save_to(editor, place, then);
               }});
}

void revert(Editor& e) {
    const fs::path path(e.session().path());
    const auto reopen = [path](Editor& editor) { editor.open_now({.path = path}); };
    if (!e.session().modified()) {
        reopen(e);
        return;
    }
    e.show_modal("Revert", [path, reopen, steps = e.session().history().position()](Editor& editor) {
        dialog_width(400);
        ImGui::TextWrapped("Give up all changes since %s was saved?", path.filename().string().c_str());
        empty_note(fmt::format("{} steps of the history go; this cannot be undone.", steps).c_str());
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

void recent_menu(Editor& e) {
    const auto& files = e.files().recent.files();
    if (!ImGui::BeginMenu("Open recent", !files.empty())) {
        e.mark("file.recent");
        return;
    }
    e.mark("file.recent");
    for (std::size_t i = 0; i < files.size(); ++i) {
        const fs::path path(files[i]);
        if (ImGui::MenuItem(fmt::format("{}##{}", path.filename().string(), i).c_str())) e.open(path);
        ImGui::SetItemTooltip("%s", files[i].c_str());
        e.mark("recent." + path.filename().string());
    }
    ImGui::Separator();
    if (ImGui::MenuItem("Forget these")) e.files().recent.clear();
    ImGui::EndMenu();
}

} // namespace restage::editor

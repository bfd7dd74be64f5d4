// SPDX-License-Identifier: Apache-2.0
// Import report: how things in the file were imported, the objects that an entry concerns, and missing files.
#include "panels.hpp"

#include "document/session.hpp"
#include "file_browser.hpp"
#include "files.hpp"
#include "importing.hpp"
#include "io/import.hpp"
#include "panel_context.hpp"
#include "plugin/registry.hpp"
#include "scene/edits.hpp"
#include "scene/placeholder.hpp"
#include "state.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_internal.h>
#include <misc/cpp/imgui_stdlib.h>
#include <algorithm>
#include <filesystem>

namespace restage::editor {

namespace {

using ImageId = scene::Id<scene::Image>;
using MeshId = scene::Id<scene::Mesh>;

// Selects the objects that an entry concerns: 'material "oak"' = the objects that have it.
bool select_named(SelectContext& e, const std::string& what) {
    const std::size_t open = what.find('"'), close = what.rfind('"');
    if (open == std::string::npos || close <= open) return false;
    const std::string name = what.substr(open + 1, close - open - 1);
    const scene::Scene& s = e.scene();
    std::vector<InstanceId> found;
    s.lights.each([&](scene::Id<scene::Light> id, const scene::Light& light) {
        if (light.name == name && what.starts_with("light")) e.selection.set_light(id);
    });
    if (e.selection.light()) return true;
    s.instances.each([&](InstanceId id, const scene::Instance& instance) {
        const scene::Material* material = s.materials.find(instance.material);
        const scene::Mesh* mesh = s.meshes.find(instance.mesh);
        bool hit = instance.name == name || (mesh && mesh->name == name) || (material && material->name == name);
        if (material && what.starts_with("texture"))
            for (const auto& entry : material->params.entries())
                if (const scene::Texture* t = s.textures.find(entry.value.texture)) hit = hit || t->name == name;
        if (hit) found.push_back(id);
    });
    if (!found.empty()) e.selection.set(found);
    return !found.empty();
}

// Reads the images from these files and, once all are read, puts them into the scene: one undo step.
void relink(EditContext& e, std::vector<std::pair<ImageId, std::string>> places) {
    struct Gathering {
        std::size_t left;
        std::vector<std::tuple<ImageId, std::string, std::shared_ptr<const scene::PixelData>>> read;
    };
    auto all = std::make_shared<Gathering>(Gathering{places.size(), {}});
    for (const auto& [id, path] : places) {
        const scene::Image& image = e.scene().images[id];
        e.panel_state->loads.start(
            {.path = path,
             .encoding = image.encoding,
             .gamma = image.gamma,
             .done = [&e, all, image_id = id,
                      image_path = path](Result<std::shared_ptr<const scene::PixelData>> pixels) {
                 if (pixels)
                     all->read.emplace_back(image_id, image_path, *pixels);
                 else
                     e.notices.add(LogLevel::error, pixels.error().message);
                 if (--all->left > 0 || all->read.empty()) return;
                 e.edit([read = all->read](const scene::Scene& s) {
                     scene::Edit edit{
                         read.size() == 1 ? "Find a missing image" : fmt::format("Find {} missing images", read.size()),
                         {}};
                     for (const auto& [one, file, data] : read) {
                         const scene::Image* before = s.images.find(one);
                         if (!before) continue;
                         scene::Image after = *before;
                         after.path = file;
                         after.data = data;
                         edit.changes.push_back(scene::Change<scene::Image>{one, *before, std::move(after)});
                     }
                     return Result<scene::Edit>(std::move(edit));
                 });
             }});
    }
}

// Reads the meshes from these files, the first of each file, and puts them into the scene: one undo step.
void relink(DocumentContext& e, std::vector<std::pair<MeshId, std::string>> places) {
    if (places.empty()) return;
    const std::string title = places.size() == 1 ? "Reading " + places[0].second : "Reading missing meshes";
    e.files().jobs.start(
        {.title = title}, [&registry = e.registry(), places](BackgroundJob& job) -> std::function<void(PanelContext&)> {
            std::vector<std::tuple<MeshId, std::string, std::shared_ptr<const scene::MeshData>>> read;
            std::vector<std::string> problems;
            for (const auto& [id, path] : places) {
                io::ImportOptions options;
                options.progress = [&job](float done, std::string_view what) { return job.report(done, what); };
                const auto imported = io::import_scene(path, registry, options);
                std::shared_ptr<const scene::MeshData> data;
                if (imported)
                    imported->scene.meshes.each([&](MeshId, const scene::Mesh& mesh) {
                        if (!data && !scene::is_missing(mesh)) data = mesh.data;
                    });
                if (data)
                    read.emplace_back(id, path, data);
                else
                    problems.push_back(imported ? path + ": contains no mesh" : imported.error().message);
            }
            return [read, problems](EditContext& editor) {
                for (const std::string& problem : problems)
                    editor.notices.add(LogLevel::error, problem);
                if (read.empty()) return;
                editor.edit([read](const scene::Scene& s) -> Result<scene::Edit> {
                    scene::Edit all{
                        read.size() == 1 ? "Find a missing mesh" : fmt::format("Find {} missing meshes", read.size()),
                        {}};
                    for (const auto& [id, file, data] : read) {
                        RESTAGE_TRY(scene::Edit one, scene::find_mesh(s, id, file, data));
                        all.changes.push_back(std::move(one.changes[0]));
                    }
                    return all;
                });
            };
        });
}

// Files with these names anywhere in the folder.
void relink_from_folder(EditContext& e, const std::vector<ImageId>& missing, const std::vector<MeshId>& meshes,
                        const std::string& folder) {
    std::map<std::string, std::string> files; // name -> path
    std::error_code error;
    constexpr std::size_t most = 100'000; // the user may have typed "/"
    std::size_t seen = 0;
    for (auto it = std::filesystem::recursive_directory_iterator(
             folder, std::filesystem::directory_options::skip_permission_denied, error);
         !error && it != std::filesystem::recursive_directory_iterator() && ++seen < most; it.increment(error))
        if (it->is_regular_file(error)) files.try_emplace(it->path().filename().string(), it->path().string());
    std::vector<std::pair<ImageId, std::string>> places;
    for (const ImageId id : missing)
        if (const auto found = files.find(std::filesystem::path(e.scene().images[id].path).filename().string());
            found != files.end())
            places.emplace_back(id, found->second);
    std::vector<std::pair<MeshId, std::string>> mesh_places;
    for (const MeshId id : meshes)
        if (const auto found = files.find(std::filesystem::path(e.scene().meshes[id].source_file).filename().string());
            found != files.end())
            mesh_places.emplace_back(id, found->second);
    if (places.empty() && mesh_places.empty())
        e.notices.add(LogLevel::warning, "None of the missing files is in " + folder);
    if (!places.empty()) relink(e, std::move(places));
    relink(e, std::move(mesh_places));
}

void missing_files(EditContext& e) {
    std::vector<ImageId> missing;
    e.scene().images.each([&](ImageId id, const scene::Image& image) {
        if (!image.data && !image.path.empty()) missing.push_back(id);
    });
    std::vector<MeshId> meshes; // that can be relinked; Include and others require reopening the scene
    std::size_t lines = 0;
    e.scene().meshes.each([&](MeshId id, const scene::Mesh& mesh) {
        if (!scene::is_missing(mesh)) return;
        if (mesh.source_file.empty() || !scene::missing_line(mesh).starts_with("Shape"))
            ++lines;
        else
            meshes.push_back(id);
    });
    if (missing.empty() && meshes.empty() && lines == 0) return;
    const auto say = [](std::size_t count, const char* one, const char* many) {
        if (count > 0) ImGui::TextColored(colors::warning, "%zu %s", count, count == 1 ? one : many);
    };
    say(missing.size(), "image was not found; it is shown grey.", "images were not found; they are shown grey.");
    say(meshes.size(), "mesh was not found; it is not shown, and kept in the file.",
        "meshes were not found; they are not shown, and kept in the file.");
    say(lines, "part of the file could not be read; it is kept in the file.",
        "parts of the file could not be read; they are kept in the file.");
    if (missing.empty() && meshes.empty()) {
        ImGui::Separator();
        return;
    }
    const std::filesystem::path document(e.session().path());
    if (flow_button("Look in a folder..."))
        browse(e, {.title = "The folder they are in",
                   .folder = true,
                   .start = document.parent_path(),
                   .done = [missing, meshes](SelectContext& editor, const std::filesystem::path& folder) {
                       relink_from_folder(editor, missing, meshes, folder.string());
                   }});
    tip("Finds files with the same names in that folder and its subfolders");
    e.mark("report.find_all");
    for (const ImageId id : missing) {
        ImGui::PushID(int(id.value));
        ImGui::AlignTextToFramePadding();
        ImGui::TextUnformatted(std::filesystem::path(e.scene().images[id].path).filename().string().c_str());
        tip(e.scene().images[id].path.c_str());
        ImGui::SameLine();
        if (ImGui::Button("Find..."))
            browse(e, {.title = "Find " + std::filesystem::path(e.scene().images[id].path).filename().string(),
                       .filters = {{"Images", {"png", "jpg", "jpeg", "exr", "hdr", "tga", "bmp", "pfm"}},
                                   {"All files", {}}},
                       .start = document.parent_path(),
                       .done = [id](SelectContext& editor, const std::filesystem::path& path) {
                           if (editor.scene().images.find(id)) relink(editor, {{id, path.string()}});
                       }});
        tip("Choose the file to use instead");
        e.mark("report.find." + e.scene().images[id].name);
        ImGui::PopID();
    }
    for (const MeshId id : meshes) {
        ImGui::PushID(int(id.value));
        ImGui::PushID("mesh");
        const std::string file = std::filesystem::path(e.scene().meshes[id].source_file).filename().string();
        ImGui::AlignTextToFramePadding();
        ImGui::TextUnformatted(file.c_str());
        tip(e.scene().meshes[id].source_file.c_str());
        ImGui::SameLine();
        if (ImGui::Button("Find..."))
            browse(e, {.title = "Find " + file,
                       .filters = {{"Meshes", {"ply", "obj", "stl", "glb", "gltf"}}, {"All files", {}}},
                       .start = document.parent_path(),
                       .done = [id](SelectContext& editor, const std::filesystem::path& path) {
                           if (editor.scene().meshes.find(id)) relink(editor, {{id, path.string()}});
                       }});
        tip("Choose the file to use instead");
        e.mark("report.find." + e.scene().meshes[id].name);
        ImGui::PopID();
        ImGui::PopID();
    }
    ImGui::Separator();
}

} // namespace

void draw_import_report(SelectContext& e) {
    ReportState& state = e.panel_state->report;
    if (why_not_import_again(e).empty()) {
        if (ImGui::Button("Import again...")) e.run("file.import_again");
        tip("Reread the file with other options");
        e.mark("report.import_again");
        ImGui::SameLine();
        const std::string options = import_options_text(e);
        ImGui::TextDisabled("%s", options.empty() ? "Read with the default options" : ("Read with " + options).c_str());
        e.mark("report.options");
    }
    missing_files(e);
    const io::Report& report = e.session().report();
    if (report.entries.empty()) {
        empty_note(e.session().path().empty() ? "Nothing was imported." : "Everything in the file was kept.");
        return;
    }
    const auto filter = [&](const char* name, io::Fate fate, bool& on, const ImVec4& color, const char* tooltip,
                            const char* mark) {
        const std::string label = fmt::format("{} {}###{}", report.count(fate), name, name);
        if (fate != io::Fate::dropped) flow(check_width(label.c_str())); // the first
        ImGui::PushStyleColor(ImGuiCol_Text, color);
        ImGui::Checkbox(label.c_str(), &on);
        ImGui::PopStyleColor();
        tip(tooltip);
        e.mark(mark);
    };
    filter("dropped", io::Fate::dropped, state.dropped, colors::error,
           "Not in the scene; written back to the file if possible", "report.dropped");
    filter("approximated", io::Fate::approximated, state.approximated, colors::warning,
           "Rendered more simply than specified in the file", "report.approximated");
    filter("kept", io::Fate::kept, state.kept, colors::good, "As specified in the file", "report.kept");
    const float width = 110 * ImGui::GetStyle().FontScaleMain;
    flow(width);
    ImGui::SetNextItemWidth(width);
    ImGui::InputTextWithHint("##search", "Search", &state.search);
    e.mark("report.search");
    std::vector<const io::ReportEntry*> shown;
    for (const io::ReportEntry& entry : report.entries) {
        const bool wanted = entry.fate == io::Fate::dropped        ? state.dropped
                            : entry.fate == io::Fate::approximated ? state.approximated
                                                                   : state.kept;
        if (wanted && (contains_word(entry.what, state.search) || contains_word(entry.note, state.search)))
            shown.push_back(&entry);
    }
    if (flow_button("Copy")) {
        std::string text;
        for (const io::ReportEntry* entry : shown)
            text += io::to_string(*entry) + "\n";
        ImGui::SetClipboardText(text.c_str());
    }
    tip("Copy the shown lines to the clipboard");
    e.mark("report.copy");
    if (shown.empty()) {
        empty_note("No line fits the filter.");
        return;
    }
    if (!ImGui::BeginTable("entries", 3,
                           ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY | ImGuiTableFlags_SizingStretchProp |
                               ImGuiTableFlags_BordersInnerV,
                           {0, std::max(ImGui::GetContentRegionAvail().y, 6 * ImGui::GetTextLineHeightWithSpacing())}))
        return; // in a low panel the part above scrolls away
    ImGui::TableSetupScrollFreeze(0, 1);
    ImGui::TableSetupColumn("What", 0, 3);
    ImGui::TableSetupColumn("How it was imported", 0, 6);
    ImGui::TableSetupColumn("Where", 0, 2);
    ImGui::TableHeadersRow();
    ImGuiListClipper clipper;
    clipper.Begin(int(shown.size()));
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            const io::ReportEntry& entry = *shown[std::size_t(i)];
            ImGui::PushID(i);
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            ImGui::PushStyleColor(ImGuiCol_Text, entry.fate == io::Fate::dropped        ? colors::error
                                                 : entry.fate == io::Fate::approximated ? colors::warning
                                                                                        : colors::good);
            if (ImGui::Selectable(entry.what.c_str(), false, ImGuiSelectableFlags_SpanAllColumns) &&
                !select_named(e, entry.what))
                e.notices.add(LogLevel::info, entry.what + " is neither an object nor used by one");
            ImGui::PopStyleColor();
            tip(fmt::format("{}: {}\n{}\nClick to select the objects it concerns", entry.what,
                            io::to_string(entry.fate), entry.note)
                    .c_str());
            e.mark(fmt::format("report.{}", i));
            ImGui::TableNextColumn();
            ImGui::TextAligned(0, -FLT_MIN, "%s%s%s", io::to_string(entry.fate), entry.note.empty() ? "" : ": ",
                               entry.note.c_str());
            ImGui::TableNextColumn();
            ImGui::PushStyleColor(ImGuiCol_Text, colors::dim);
            if (!entry.file.empty())
                ImGui::TextAligned(0, -FLT_MIN, "%s:%u", std::filesystem::path(entry.file).filename().string().c_str(),
                                   entry.line);
            ImGui::PopStyleColor();
            ImGui::PopID();
        }
    ImGui::EndTable();
}

} // namespace restage::editor

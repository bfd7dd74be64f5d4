// SPDX-License-Identifier: Apache-2.0
#include "linking.hpp"

#include "document/linking.hpp"
#include "editor.hpp"
#include "files.hpp"
#include "plugin/registry.hpp"
#include "scene/links.hpp"
#include "scene/share_materials.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <memory>
#include <set>
#include <vector>

namespace restage::editor {

namespace fs = std::filesystem;

namespace {

// Reads the file once for each set of import options, then replaces the links to it.
void reload(Editor& e, const std::string& file) {
    std::vector<std::pair<GroupId, scene::LinkSource>> links;
    for (const GroupId id : scene::all_links(e.scene()))
        if (const auto source = scene::link_source(e.scene().groups[id]); source->file == file)
            links.emplace_back(id, *source);
    if (links.empty()) return;
    e.files().jobs.start(
        {.title = "Reading " + fs::path(file).filename().string()},
        [links, file, &registry = e.registry(), isolate = e.options().isolate,
         &e](BackgroundJob&) -> std::function<void(PanelContext&)> {
            std::vector<std::pair<GroupId, std::shared_ptr<const io::ImportedScene>>> read;
            for (std::size_t i = 0; i < links.size(); ++i) {
                const auto& [id, source] = links[i];
                if (i > 0 && source == links[i - 1].second) {
                    read.emplace_back(id, read.back().second);
                    continue;
                }
                document::ReadOptions reading = document::reading_of(source, registry);
                reading.isolate = isolate;
                auto scene = document::read_scene(file, registry, reading, source.format);
                if (!scene)
                    return [message = scene.error().message](PanelContext& editor) {
                        editor.notices.add(LogLevel::error, message);
                    };
                read.emplace_back(id, std::make_shared<const io::ImportedScene>(std::move(*scene)));
            }
            return [read, file, &e](PanelContext&) {
                e.later([read, file, &e] {
                    for (const auto& [id, scene] : read) {
                        const scene::Group* group = e.scene().groups.find(id); // it may be gone by now
                        if (!group || !scene::link_source(*group)) continue;
                        if (const auto done = document::reload_link(e.session_for_changes(), id, *scene); !done)
                            return e.notices.add(LogLevel::error, done.error().message);
                    }
                    e.notices.add(LogLevel::info, fs::path(file).filename().string() + " was read again");
                });
            };
        });
}

std::set<std::string> linked_files(const scene::Scene& s) {
    std::set<std::string> files;
    for (const GroupId id : scene::all_links(s))
        files.insert(scene::link_source(s.groups[id])->file);
    return files;
}

void complete_selection(SelectContext& e) {
    std::vector<InstanceId> more;
    std::set<GroupId> seen;
    for (const InstanceId id : e.selection.instances()) {
        const scene::Instance* instance = e.scene().instances.find(id);
        const GroupId link = instance ? scene::link_of(e.scene(), instance->group) : GroupId{};
        if (!link || !seen.insert(link).second) continue;
        for (const InstanceId one : scene::objects_of(e.scene(), link))
            if (!e.selection.contains(one)) more.push_back(one);
    }
    if (more.empty()) return;
    more.push_back(e.selection.active()); // remains the active object
    e.selection.set(more, Selection::Mode::add);
}

} // namespace

void LinkWatch::follow(Editor& e) {
    if (const scene::Version now = e.scene().groups.version(); now != seen_) {
        seen_ = now;
        any_ = !scene::all_links(e.scene()).empty();
    }
    if (!any_) return times_.clear();
    complete_selection(e);
    look_at_files(e);
}

void LinkWatch::look_at_files(Editor& e) {
    constexpr double every = 1; // [s]
    if (ImGui::GetTime() < looked_at_ + every) return;
    looked_at_ = ImGui::GetTime();
    const std::set<std::string> files = linked_files(e.scene());
    std::erase_if(times_, [&](const auto& one) { return !files.contains(one.first); });
    for (const std::string& file : files) {
        std::error_code code;
        const fs::file_time_type time = fs::last_write_time(file, code);
        if (code) continue; // missing, or just being replaced
        const auto [known, fresh] = times_.try_emplace(file, time);
        if (!fresh && known->second != time) {
            known->second = time;
            reload(e, file);
        }
    }
}

GroupId selected_link(const SelectContext& e) {
    const scene::Instance* active = e.scene().instances.find(e.selection.active());
    return active ? scene::link_of(e.scene(), active->group) : GroupId{};
}

void link_note(PanelUi& e, const scene::Group& group) {
    const auto source = scene::link_source(group);
    if (!source) return;
    const char* word = "linked";
    const ImVec2 lower = ImGui::GetItemRectMin(), upper = ImGui::GetItemRectMax();
    const ImVec2 size = ImGui::CalcTextSize(word);
    const float eye = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemSpacing.x; // at the right end of the row
    const ImVec2 at(upper.x - eye - size.x, (lower.y + upper.y - size.y) / 2);
    ImGui::GetWindowDrawList()->AddText(at, ImGui::GetColorU32(colors::dim), word);
    tip(fmt::format("Linked from {}. Moved, hidden, copied and deleted as a whole", source->file).c_str());
    e.mark("outliner.linked." + group.name);
}

void reload_links(Editor& e) {
    for (const std::string& file : linked_files(e.scene()))
        reload(e, file);
}

void make_link_editable(Editor& e) {
    e.edit([link = selected_link(e)](const scene::Scene& s) { return scene::make_editable(s, link); });
}

void merge_materials(Editor& e) {
    e.later([&e] {
        scene::MergedMaterials merged = scene::merge_equal_materials(e.scene());
        const std::string kept =
            merged.other_names > 0 ? fmt::format("; {} equal ones of other names are kept", merged.other_names) : "";
        if (merged.merged > 0)
            if (const auto done = e.session_for_changes().edit(std::move(merged.edit)); !done)
                return e.notices.add(LogLevel::error, done.error().message);
        e.notices.add(LogLevel::info, merged.merged > 0
                                          ? fmt::format("{} materials merged with equal ones{}", merged.merged, kept)
                                          : "No materials are equal and called the same" + kept);
    });
}

} // namespace restage::editor

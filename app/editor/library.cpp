// SPDX-License-Identifier: Apache-2.0
#include "library.hpp"

#include "base/file.hpp"
#include "document/projected.hpp"
#include "document/session.hpp"
#include "drop.hpp"
#include "files.hpp"
#include "panel_context.hpp"
#include "panels/state.hpp"
#include "plugin/registry.hpp"
#include "project_texture.hpp"
#include "viewport.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <set>

namespace restage::editor {

namespace fs = std::filesystem;

namespace {

constexpr double dwell = 0.3, grace = 0.15; // [s] before a ball is tried, and after the mouse has left it

fs::path own_folder(const PanelUi& e) {
    return e.options().config_dir.empty() ? fs::path() : e.options().config_dir / "materials";
}

void load(DocumentContext& e, LibraryState& state) {
    state.loaded = true;
    state.plugins = e.registry().version();
    state.presets.clear();
    const auto add = [&](const fs::path& folder, const std::string& from) {
        document::PresetFolder read = document::presets_in(folder, e.registry());
        for (const std::string& problem : read.problems)
            if (e.panel_state->said.insert(problem).second) e.notices.add(LogLevel::warning, problem);
        for (document::Preset& preset : read.presets) {
            LibraryItem item{.key = "preset:" + preset.file.string(),
                             .name = preset.name,
                             .category = preset.category,
                             .from = from,
                             .preset = nullptr,
                             .material = {}};
            item.preset = std::make_shared<const document::Preset>(std::move(preset));
            state.presets.push_back(std::move(item));
        }
    };
    if (const fs::path own = own_folder(e); !own.empty()) add(own, own_presets);
    if (const auto bin = executable_dir()) add(bin->parent_path() / "share/restage/materials", "Restage");
    for (const plugin::Entry* entry : e.registry().entries())
        if (entry->state == plugin::State::loaded) add(entry->folder / "presets", entry->name());
    std::stable_sort(state.presets.begin(), state.presets.end(), [](const LibraryItem& a, const LibraryItem& b) {
        return std::tie(a.category, a.name) < std::tie(b.category, b.name);
    });
}

bool decoded(const document::Preset& preset) {
    bool all = true;
    preset.parts.images.each([&](auto, const scene::Image& i) { all &= i.data != nullptr; });
    return all;
}

// The objects that a material dropped on `on` goes to.
std::vector<InstanceId> objects_in(const scene::Scene& s, const MaterialScope& scope) {
    const scene::Instance* first = scope.objects.empty() ? nullptr : s.instances.find(scope.objects.back());
    if (scope.alone || !first || !s.materials.find(first->material)) return scope.objects;
    std::vector<InstanceId> all;
    s.instances.each([&](InstanceId id, const scene::Instance& i) {
        if (i.material == first->material) all.push_back(id);
    });
    return all;
}

} // namespace

const std::vector<LibraryItem>& presets_of(DocumentContext& e) {
    LibraryState& state = e.panel_state->library;
    if (!state.loaded || state.plugins != e.registry().version()) load(e, state);
    return state.presets;
}

std::vector<LibraryItem> materials_of(const DocumentContext& e) {
    std::vector<LibraryItem> all;
    e.scene().materials.each([&](scene::Id<scene::Material> id, const scene::Material& m) {
        all.push_back({.key = fmt::format("material:{}", id.value),
                       .name = m.name,
                       .category = in_this_scene,
                       .from = "this scene",
                       .preset = nullptr,
                       .material = id});
    });
    return all;
}

std::optional<LibraryItem> library_item(DocumentContext& e, std::string_view key) {
    const auto in = [key](const std::vector<LibraryItem>& list) -> std::optional<LibraryItem> {
        const auto found = std::ranges::find(list, key, &LibraryItem::key);
        return found == list.end() ? std::nullopt : std::optional(*found);
    };
    if (key.starts_with("file:")) return in(e.panel_state->library.borrowed);
    return key.starts_with("preset:") ? in(presets_of(e)) : in(materials_of(e));
}

std::vector<std::string> categories_of(DocumentContext& e) {
    std::set<std::string> all;
    for (const LibraryItem& item : presets_of(e))
        all.insert(item.category);
    return {all.begin(), all.end()};
}

namespace {

EditContext::Builder only_giving(const LibraryItem& item, std::vector<InstanceId> objects) {
    if (item.preset)
        return [preset = item.preset, objects = std::move(objects)](const scene::Scene& s) {
            return document::give_preset(s, *preset, objects);
        };
    return [id = item.material, objects = std::move(objects)](const scene::Scene& s) -> Result<scene::Edit> {
        RESTAGE_TRY(scene::Edit edit, scene::set_material(s, objects, id));
        edit.label = "Material " + s.materials[id].name;
        return edit;
    };
}

} // namespace

EditContext::Builder giving(DocumentContext& e, const LibraryItem& item, std::vector<InstanceId> objects) {
    auto give = only_giving(item, objects);
    return [&e, give = std::move(give), objects = std::move(objects)](const scene::Scene& s) {
        return project_where_needed(e, s, give(s), objects);
    };
}

void with_images(PanelUi& e, LibraryItem item, std::function<void(PanelUi&, const LibraryItem&)> then) {
    if (!item.preset || decoded(*item.preset)) return then(e, item);
    const std::string title = "Reading " + item.name;
    e.files().jobs.start(
        {.title = title},
        [item = std::move(item), then = std::move(then)](BackgroundJob&) -> std::function<void(PanelContext&)> {
            auto preset = std::make_shared<document::Preset>(*item.preset);
            if (auto read = document::read_images(*preset); !read)
                return [message = read.error().message](PanelContext& editor) {
                    editor.notices.add(LogLevel::error, message);
                };
            return [item, preset, then](PanelContext& editor) {
                LibraryItem ready = item;
                ready.preset = preset;
                for (LibraryItem& one : editor.panel_state->library.presets)
                    if (one.key == item.key && one.preset == item.preset) one.preset = preset; // not decoded again
                then(editor, ready);
            };
        });
}

void give_to_selection(SelectContext& e, const LibraryItem& item) {
    const auto objects = e.selection.instances();
    if (objects.empty()) {
        e.notices.add(LogLevel::info, "Select an object first, or drag the material onto one");
        return;
    }
    LibraryState& state = e.panel_state->library;
    state.done = item.key;
    state.tried.clear();
    state.trial = {};
    with_images(e, item, [&e, objects](PanelUi&, const LibraryItem& ready) { e.edit(giving(e, ready, objects)); });
}

void follow_hover(SelectContext& e, const LibraryItem* under_mouse) {
    LibraryState& state = e.panel_state->library;
    const double now = ImGui::GetTime();
    const auto& objects = e.selection.instances();
    const std::string key =
        under_mouse && !objects.empty() && !ImGui::IsMouseDown(ImGuiMouseButton_Left) ? under_mouse->key : "";
    state.frame = ImGui::GetFrameCount();
    if (key != state.hovered) {
        state.hovered = key;
        state.since = now;
        if (key != state.done) state.done.clear();
    }
    // On the way to another ball the picture stays.
    const bool left = (key.empty() || key == state.done) && now - state.since > grace;
    if (!state.tried.empty() && (left || objects != state.on)) {
        state.trial = {};
        state.tried.clear();
    }
    if (key.empty() || key == state.tried || key == state.done || now - state.since < dwell) return;
    state.tried = key;
    state.on = objects;
    with_images(e, *under_mouse, [&e](PanelUi& ui, const LibraryItem& ready) {
        LibraryState& to = ui.panel_state->library;
        if (to.tried != ready.key) return; // the mouse has left it
        to.trial = {.number = ++to.trials,
                    .build = [&registry = e.registry(), up = e.up(), give = only_giving(ready, to.on),
                              on = to.on](const scene::Scene& s) -> Result<scene::Edit> {
                        RESTAGE_TRY(scene::Edit edit, give(s));
                        return document::project_where_needed(s, std::move(edit), on, registry, up).edit;
                    }};
    });
}

Trial current_trial(const LibraryState& state) { return state.frame == ImGui::GetFrameCount() ? state.trial : Trial{}; }

void preview_material_drop(PanelContext& e, const std::string& key, ImVec2 screen) {
    const auto item = library_item(e, key);
    if (!item) return;
    const InstanceId on = target_at(e, e.viewport.film_point(screen));
    e.drop_target = on;
    const scene::Instance* object = e.scene().instances.find(on);
    drop_tip(e, object ? fmt::format("{} onto {}", item->name, object->name) : item->name + ": drop it on an object",
             object ? object->name : "", screen);
}

void drop_material(PanelContext& e, const std::string& key, ImVec2 screen) {
    const auto item = library_item(e, key);
    const InstanceId on = target_at(e, e.viewport.film_point(screen));
    if (item && on) drop_material(e, *item, on);
}

void drop_material(PanelContext& e, const LibraryItem& item, InstanceId on) {
    ask_scope(e, {on}, item.name, [item](SelectContext& editor, const MaterialScope& scope) {
        with_images(editor, item, [&editor, scope](PanelUi&, const LibraryItem& ready) {
            editor.edit(giving(editor, ready, objects_in(editor.scene(), scope)));
        });
    });
}

} // namespace restage::editor

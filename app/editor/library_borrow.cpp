// SPDX-License-Identifier: Apache-2.0
// Materials for the library from outside: of other scenes' files, and presets dropped on the window.
#include "document/document.hpp"
#include "document/session.hpp"
#include "drop.hpp"
#include "file_browser.hpp"
#include "files.hpp"
#include "library.hpp"
#include "panel_context.hpp"
#include "panels/state.hpp"
#include "plugin/registry.hpp"
#include "saving.hpp"
#include "scene/edits.hpp"
#include "scene/same_material.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <iterator>

namespace restage::editor {

namespace fs = std::filesystem;

namespace {

// Materials that look alike are listed once.
std::vector<LibraryItem> items_of(const scene::Scene& scene, const fs::path& file) {
    std::vector<LibraryItem> items;
    std::vector<std::uint64_t> seen;
    scene.materials.each([&](scene::Id<scene::Material> id, const scene::Material& material) {
        const std::uint64_t hash = scene::material_hash(scene, id);
        if (std::ranges::find(seen, hash) != seen.end()) return;
        auto preset = document::preset_of(scene, id);
        if (!preset) return;
        seen.push_back(hash);
        const std::string name = file.filename().string();
        preset->category = name;
        preset->source = "from " + file.string();
        preset->file = fmt::format("{}#{}", file.string(), id.value); // where its ball belongs
        preset->hash = hash;
        items.push_back({.key = "file:" + preset->file.string(),
                         .name = material.name,
                         .category = name,
                         .from = name,
                         .preset = std::make_shared<const document::Preset>(std::move(*preset)),
                         .material = {}});
    });
    return items;
}

using Done = std::function<void(PanelContext&)>;
Done problem(std::string text) {
    return [text = std::move(text)](PanelContext& e) { e.notices.add(LogLevel::error, text); };
}

// A copy in the user's presets.
void keep_preset(PanelUi& e, document::Preset preset) {
    if (e.options().config_dir.empty())
        return e.notices.add(LogLevel::error, "There is no configuration folder to keep presets in");
    const fs::path folder = e.options().config_dir / "materials";
    std::error_code code;
    fs::create_directories(folder, code);
    const fs::path file = folder / document::preset_file_name(preset.name);
    if (fs::exists(file, code))
        return e.notices.add(LogLevel::warning,
                             fmt::format("You have a preset {} already: {}", preset.name, file.string()));
    if (const auto written = document::write_preset(preset, file); !written)
        return e.notices.add(LogLevel::error, written.error().message);
    e.panel_state->library.loaded = false;
    e.notices.add(LogLevel::info, fmt::format("{} is one of your presets now", preset.name));
}

} // namespace

void borrow_materials(DocumentContext& e, const fs::path& file) {
    e.files().jobs.start(
        {.title = "Reading the materials of " + file.filename().string()},
        [file, &registry = e.registry(), isolate = e.options().isolate](BackgroundJob& job) -> Done {
            const auto read = document::read_document(
                file.string(), registry,
                {.progress = [&job](float done, std::string_view what) { return job.report(double(done), what); },
                 .isolate = isolate,
                 .expose = false});
            if (!read) return read.error().cancelled() ? Done([](PanelContext&) {}) : problem(read.error().message);
            scene::Scene scene = read->base.scene;
            scene::apply(scene, read->changes);
            return [items = items_of(scene, file), name = file.filename().string(),
                    prefix = "file:" + file.string() + "#"](PanelContext& editor) {
                LibraryState& state = editor.panel_state->library;
                std::erase_if(state.borrowed, [&](const LibraryItem& one) { return one.key.starts_with(prefix); });
                state.borrowed.insert(state.borrowed.begin(), items.begin(), items.end());
                state.search.clear();
                state.category = items.empty() ? "" : name;
                editor.notices.add(
                    items.empty() ? LogLevel::warning : LogLevel::info,
                    items.empty() ? name + " has no materials" : fmt::format("{}: {} materials", name, items.size()));
            };
        });
}

void ask_borrow_materials(EditContext& e) {
    browse(e, {.title = "Materials of a file",
               .filters = scene_filters(e.registry(), true),
               .done = [](PanelContext& editor, const fs::path& file) { borrow_materials(editor, file); }});
}

void drop_preset(PanelContext& e, const fs::path& file, InstanceId on) {
    auto read = document::read_preset(file, e.registry());
    if (!read) return e.notices.add(LogLevel::error, read.error().message);
    LibraryItem item{.key = "preset:" + file.string(),
                     .name = read->name,
                     .category = read->category,
                     .from = file.filename().string(),
                     .preset = std::make_shared<const document::Preset>(std::move(*read)),
                     .material = {}};
    if (on) return drop_material(e, item, on);
    with_images(e, item, [](PanelUi& ui, const LibraryItem& ready) { keep_preset(ui, *ready.preset); });
}

} // namespace restage::editor

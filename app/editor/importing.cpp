// SPDX-License-Identifier: Apache-2.0
#include "importing.hpp"

#include "dialog_keys.hpp"
#include "document/session.hpp"
#include "editor.hpp"
#include "io/options.hpp"
#include "panels/state.hpp"
#include "param_widget.hpp"
#include "plugin/registry.hpp"
#include "saving.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <memory>

namespace restage::editor {

namespace fs = std::filesystem;

namespace {

// By its extension: probing would read the file, perhaps from a slow disk.
std::optional<plugin::ImporterEntry> importer_with_options(const plugin::Registry& registry, const fs::path& file) {
    std::string name = file.filename().string();
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    for (const auto& entry : registry.importers())
        for (const std::string& extension : entry.table->extensions)
            if (name.ends_with("." + extension))
                return entry.table->options.empty() ? std::nullopt : std::optional(entry);
    return std::nullopt;
}

std::optional<plugin::ImporterEntry> importer_of_document(const DocumentContext& e) {
    const document::Base& base = e.session().base();
    if (base.file.empty()) return std::nullopt;
    auto entry = e.registry().find_importer(base.format);
    return entry && !entry->table->options.empty() ? entry : std::nullopt;
}

// A row for each option. Values that are no longer valid are shown as the default.
void option_rows(EditContext& e, const model::Importer& importer, scene::ParamSet& values, bool focus) {
    for (const model::Param& line : importer.options) {
        const scene::Value* set = values.find(line.id);
        if (set && !misfit(line, *set).empty()) set = nullptr;
        if (std::exchange(focus, false)) {
            ImGui::SetKeyboardFocusHere();
            ImGui::SetNavCursorVisible(true);
        }
        const ParamAsk ask = param_widget(e, line, set ? *set : scene::default_value(line), set != nullptr,
                                          "import." + importer.format + "." + line.id);
        if (ask.reset || (ask.value && *ask.value == scene::default_value(line)))
            values.remove(line.id);
        else if (ask.value)
            values.set(line.id, *ask.value);
    }
}

} // namespace

void import_options_part(EditContext& e, const fs::path& file, bool focus) {
    const auto entry = importer_with_options(e.registry(), file);
    if (!entry) return;
    const model::Importer& importer = *entry->table;
    ImportState& state = e.panel_state->importing;
    if (state.file != file.filename()) { // a text, such as the name of a scene, is specific to one file
        state.file = file.filename();
        for (const model::Param& line : importer.options)
            if (line.type == model::ParamType::text) state.options[importer.format].remove(line.id);
    }
    scene::ParamSet& values = state.options[importer.format];
    if (focus) ImGui::SetNextItemOpen(true);
    const bool open = section_header("Options (Alt+O)", !fitting(importer.options, values).entries().empty());
    tip(fmt::format("Options for reading {}", importer.label).c_str());
    e.mark("browser.options");
    if (open) option_rows(e, importer, values, focus);
}

std::optional<scene::ParamSet> import_options_for(const DocumentContext& e, const fs::path& file) {
    const auto entry = importer_with_options(e.registry(), file);
    const auto& options = e.panel_state->importing.options;
    const auto found = entry ? options.find(entry->table->format) : options.end();
    if (found == options.end()) return std::nullopt;
    return fitting(entry->table->options, found->second);
}

std::string why_not_import_again(const DocumentContext& e) {
    if (e.session().base().file.empty()) return "The scene was not read from a file";
    return importer_of_document(e) ? "" : "Its importer has no options";
}

std::string import_options_text(const DocumentContext& e) {
    std::string text;
    for (const auto& [id, value] : e.session().base().options.entries())
        text += (text.empty() ? "" : ", ") + id + "=" + io::option_text(value);
    return text;
}

void read_again(Editor& e) {
    const auto entry = importer_of_document(e);
    if (!entry) return;
    const auto chosen = e.panel_state->importing.options.find(entry->table->format);
    const scene::ParamSet options =
        fitting(entry->table->options,
                chosen == e.panel_state->importing.options.end() ? e.session().base().options : chosen->second);
    ask_unsaved(e, "reading it again", [options](Editor& now) {
        const std::string& path = now.session().path();
        now.open_now({.path = path.empty() ? now.session().base().file : path, .import_options = options});
    });
}

void import_again(Editor& e) {
    struct State {
        scene::ParamSet values;
        KeyNavigation navigation;
        bool list_open = false;
    };
    const auto state = std::make_shared<State>();
    state->values = e.session().base().options;
    e.show_modal("Import again", [state, &editor = e](PanelContext& context) {
        const auto entry = importer_of_document(context);
        if (!entry) return false; // it was unloaded
        dialog_width(400);
        ImGui::TextWrapped("%s", fs::path(context.session().base().file).filename().string().c_str());
        empty_note("The file is reread and the document reopened: its history starts again.");
        ImGui::Spacing();
        option_rows(context, *entry->table, state->values, ImGui::IsWindowAppearing());
        ImGui::Spacing();
        bool stay = true;
        if (ImGui::Button("Import")) {
            stay = false;
            const scene::ParamSet options = fitting(entry->table->options, state->values);
            context.panel_state->importing.options[entry->table->format] = options;
            editor.later([&editor] { read_again(editor); });
        }
        tip("A project keeps the changes that still apply to the scene");
        context.mark("import.again");
        ImGui::SameLine();
        if (ImGui::Button("Cancel") || dialog_escape(state->list_open)) stay = false;
        context.mark("import.cancel");
        return stay;
    });
}

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
// The dialog that saves a material of the scene as a preset.
#include "base/file.hpp"
#include "files.hpp"
#include "library.hpp"
#include "panel_context.hpp"
#include "panels/state.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <misc/cpp/imgui_stdlib.h>

namespace restage::editor {

namespace fs = std::filesystem;

namespace {

struct Saving {
    std::string name, category, source;
    std::vector<std::string> categories;
    std::string problem; // of the last attempt
    fs::path replaces; // asked about already
};

// True once it is written.
bool save(EditContext& e, Saving& saving, scene::Id<scene::Material> material) {
    const fs::path folder = e.options().config_dir / "materials",
                   file = folder / document::preset_file_name(saving.name);
    std::error_code code;
    if (fs::exists(file, code) && saving.replaces != file) {
        saving.replaces = file;
        return false;
    }
    fs::create_directories(folder, code);
    auto preset = document::preset_of(e.scene(), material);
    const auto written = [&]() -> Result<> {
        if (!preset) return fail(preset.error().message);
        preset->name = saving.name;
        preset->category = saving.category;
        preset->source = saving.source;
        return document::write_preset(*preset, file);
    }();
    if (!written) {
        saving.problem = written.error().message;
        return false;
    }
    e.panel_state->library.loaded = false;
    e.notices.add(LogLevel::info, fmt::format("Saved the preset {}: {}", saving.name, file.string()));
    return true;
}

} // namespace

void ask_save_preset(EditContext& e, scene::Id<scene::Material> id) {
    const scene::Material* material = e.scene().materials.find(id);
    if (!material) return;
    if (e.options().config_dir.empty()) {
        e.notices.add(LogLevel::error, "There is no configuration folder to save presets in");
        return;
    }
    auto saving = std::make_shared<Saving>();
    saving->name = material->name;
    saving->categories = categories_of(e);
    saving->category = "Other";
    e.show_modal("Save as preset", [saving, id](PanelContext& editor) {
        dialog_width(420);
        ImGui::TextWrapped("The material with its textures, for the panel Materials of every scene.");
        ImGui::Spacing();
        form_row("Name", "Also of the file in your folder of presets");
        if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
        ImGui::InputText("##name", &saving->name);
        editor.mark("preset.name");
        form_row("Category", "What it is: choose or type one");
        ImGui::SetNextItemWidth(ImGui::CalcItemWidth() - ImGui::GetFrameHeight());
        ImGui::InputText("##category", &saving->category);
        editor.mark("preset.category");
        ImGui::SameLine(0, 0);
        if (ImGui::BeginCombo("##categories", nullptr, ImGuiComboFlags_NoPreview | ImGuiComboFlags_HeightLarge)) {
            for (const std::string& one : saving->categories) {
                if (ImGui::Selectable(one.c_str(), one == saving->category)) saving->category = one;
                editor.mark("preset.category." + one);
            }
            ImGui::EndCombo();
        }
        editor.mark("preset.categories");
        form_row("Source", "Where its numbers come from, for those who use it");
        ImGui::InputTextWithHint("##source", "chosen by eye", &saving->source);
        editor.mark("preset.source");
        const bool complete = !saving->name.empty() && !saving->category.empty();
        const bool replace =
            complete &&
            editor.options().config_dir / "materials" / document::preset_file_name(saving->name) == saving->replaces;
        if (replace) warning_note("You have a preset of this name already.");
        if (!saving->problem.empty()) error_note(saving->problem.c_str());
        ImGui::Spacing();
        bool stay = true;
        ImGui::BeginDisabled(!complete);
        const bool save_now = ImGui::Button(replace ? "Replace it###save" : "Save###save") ||
                              (complete && ImGui::IsKeyPressed(ImGuiKey_Enter, false));
        ImGui::EndDisabled();
        editor.mark("preset.save");
        if (save_now) stay = !save(editor, *saving, id);
        ImGui::SameLine();
        if (ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGuiKey_Escape, false)) stay = false;
        editor.mark("preset.cancel");
        return stay;
    });
}

} // namespace restage::editor

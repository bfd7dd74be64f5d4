// SPDX-License-Identifier: Apache-2.0
// The section of the Scene panel for files with several scenes or variants of their materials: another one is read.
#include "scene_panel.hpp"

#include "document/session.hpp"
#include "io/choices.hpp"
#include "plugin/registry.hpp"
#include "state.hpp"
#include "widgets.hpp"

#include <imgui.h>
#include <algorithm>

namespace restage::editor {

void choices_section(EditContext& e) {
    const document::Base& base = e.session().base();
    const auto importer = base.file.empty() ? std::nullopt : e.registry().find_importer(base.format);
    if (!importer) return;
    for (const io::Choices& choices : io::choices_of(e.session().report())) {
        const auto& lines = importer->table->options;
        const auto line = std::ranges::find(lines, choices.option, &model::Param::id);
        if (line == lines.end() || line->type != model::ParamType::text) continue;
        const scene::Value* set = base.options.find(choices.option);
        const std::string now = set ? set->text : "";
        ImGui::PushID(choices.option.c_str());
        form_row(line->label.c_str(), "The file has several; another one is read, and the history starts again");
        ImGui::SetNextItemWidth(-FLT_MIN);
        if (ImGui::BeginCombo("##choice", now.empty() ? "As in the file" : now.c_str())) {
            const auto choose = [&](const std::string& value, const char* label) {
                if (ImGui::Selectable(label, value == now) && value != now) {
                    scene::ParamSet options = base.options;
                    options.remove(choices.option);
                    if (!value.empty()) options.set(choices.option, {.type = scene::ParamType::text, .text = value});
                    e.panel_state->importing.options[base.format] = std::move(options);
                    e.run("file.read_again");
                }
                e.mark("scene.choice." + choices.option + "." + value);
            };
            choose("", "As in the file");
            for (const std::string& value : choices.values)
                choose(value, value.c_str());
            ImGui::EndCombo();
        }
        e.mark("scene.choice." + choices.option);
        ImGui::PopID();
    }
}

} // namespace restage::editor

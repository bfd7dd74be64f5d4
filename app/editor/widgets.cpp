// SPDX-License-Identifier: Apache-2.0
#include "widgets.hpp"

#include "editor.hpp"
#include "theme.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <misc/cpp/imgui_stdlib.h>
#include <cmath>
#include <string_view>

namespace restage::editor {

namespace {

// The largest value a slider can usefully span; beyond it a drag is better.
constexpr float slider_span = 20;

bool number(const RestageParam& line, const char* label, float& v) {
    const std::string format = *line.unit ? fmt::format("%.4g {}", line.unit) : "%.4g";
    if (line.max - line.min <= slider_span)
        return ImGui::SliderFloat(label, &v, line.min, line.max, format.c_str(), ImGuiSliderFlags_AlwaysClamp);
    return ImGui::DragFloat(label, &v, std::max(1e-4f, std::abs(v) * 0.01f), line.min, line.max, format.c_str(),
                            ImGuiSliderFlags_AlwaysClamp);
}

} // namespace

std::optional<scene::Value> param_widget(Editor& e, const RestageParam& line, const scene::Value& value,
                                         const std::string& mark) {
    scene::Value v = value;
    bool changed = false;
    ImGui::PushID(line.id);
    if (const scene::Texture* texture = e.scene().textures.find(value.texture)) {
        ImGui::AlignTextToFramePadding();
        ImGui::TextColored(colors::hover, "%s", texture->name.c_str());
        ImGui::SameLine();
        if (ImGui::SmallButton("Remove")) {
            v.texture = {};
            changed = true;
        }
        ImGui::SameLine();
        ImGui::TextUnformatted(line.label);
    } else {
        switch (static_cast<RestageType>(line.type)) {
            case RESTAGE_FLOAT:
                changed = number(line, line.label, v.v[0]);
                break;
            case RESTAGE_COLOR:
                changed = ImGui::ColorEdit3(line.label, v.v.data(),
                                            ImGuiColorEditFlags_Float | (line.max > 1 ? ImGuiColorEditFlags_HDR : 0));
                break;
            case RESTAGE_INT: {
                int i = int(v.v[0]);
                changed =
                    ImGui::SliderInt(line.label, &i, int(line.min), int(line.max), "%d", ImGuiSliderFlags_AlwaysClamp);
                v.v[0] = float(i);
                break;
            }
            case RESTAGE_BOOL: {
                bool on = v.v[0] != 0;
                changed = ImGui::Checkbox(line.label, &on);
                v.v[0] = on ? 1.f : 0.f;
                break;
            }
            case RESTAGE_ENUM:
                if (ImGui::BeginCombo(line.label, v.text.c_str())) {
                    std::string_view rest = line.choices;
                    while (!rest.empty()) {
                        const std::string choice(rest.substr(0, rest.find('|')));
                        rest.remove_prefix(std::min(rest.size(), choice.size() + 1));
                        if (ImGui::Selectable(choice.c_str(), choice == v.text)) {
                            v.text = choice;
                            changed = true;
                        }
                    }
                    ImGui::EndCombo();
                }
                break;
            case RESTAGE_TEXT:
                changed = ImGui::InputText(line.label, &v.text);
                break;
            case RESTAGE_MATERIAL: {
                const scene::Material* current = e.scene().materials.find(v.material);
                if (ImGui::BeginCombo(line.label, current ? current->name.c_str() : "none")) {
                    e.scene().materials.each([&](scene::Id<scene::Material> id, const scene::Material& m) {
                        if (ImGui::Selectable(fmt::format("{}##{}", m.name, id.value).c_str(), id == v.material)) {
                            v.material = id;
                            changed = true;
                        }
                    });
                    ImGui::EndCombo();
                }
                break;
            }
            case RESTAGE_TEXTURE:
                ImGui::LabelText(line.label, "none");
                break;
        }
    }
    e.mark(mark);
    if (line.tooltip && *line.tooltip) ImGui::SetItemTooltip("%s", line.tooltip);
    ImGui::PopID();
    return changed ? std::optional(v) : std::nullopt;
}

} // namespace restage::editor

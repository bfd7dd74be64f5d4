// SPDX-License-Identifier: Apache-2.0
// Light mixer: a fader for each light, or the lights of one kind, and the mix in the viewport.
#include "inspector.hpp"
#include "light_buttons.hpp"
#include "light_mixing.hpp"
#include "panels.hpp"
#include "state.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <cmath>
#include <vector>

namespace restage::editor {

namespace {

float strength(const glm::vec3& weight) { return std::max({weight.x, weight.y, weight.z, 1e-6f}); }

void select_layer(SelectContext& e, const view::LightLayer& layer) {
    std::vector<InstanceId> objects;
    for (const view::LightKey key : layer.lights)
        if (key.kind == view::LightKey::Kind::light)
            return e.selection.set_light({key.id});
        else if (key.kind == view::LightKey::Kind::object)
            objects.push_back({key.id});
    if (!objects.empty()) e.selection.set(objects);
}

// The weight's colour and strength as numbers, behind the swatch.
void weight_popup(PanelUi& e, glm::vec3& weight, const std::string& mark) {
    if (!ImGui::BeginPopup("weight")) return;
    dialog_width(260);
    light_value_rows(e, weight, "Strength", "×", mark);
    ImGui::EndPopup();
}

// The part of a spot's light that comes from this layer, and more of it by a click.
void share_cell(PanelUi& e, std::size_t index, const std::string& mark) {
    LightMixing& mixing = e.panel_state->mixing;
    const double share = mixing.shares()[index];
    ImGui::BeginDisabled(share < 1e-3);
    if (ImGui::Button(fmt::format("{:.0f} %##share", 100 * share).c_str(), {-FLT_MIN, 0}))
        mixing.brighten(index, ImGui::GetIO().KeyShift ? 0.5 : 2);
    ImGui::EndDisabled();
    tip("Of the spot's light. A click makes the spot twice as bright by this light alone; Shift+click half as bright");
    e.mark(mark + ".share");
}

void layer_row(SelectContext& e, std::size_t index, const view::LightLayer& layer, glm::vec3& weight) {
    const std::string mark = "mixer." + layer.name;
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::AlignTextToFramePadding();
    if (ImGui::Selectable(layer.name.c_str())) select_layer(e, layer);
    tip(fmt::format("{}: {}", layer.kind, layer.name).c_str());
    e.mark(mark);
    ImGui::TableNextColumn();
    ImGui::SetNextItemWidth(-FLT_MIN);
    const float before = strength(weight);
    if (float stops = std::log2(before);
        ImGui::SliderFloat("##stops", &stops, -6, 6, "%+.2f EV", ImGuiSliderFlags_AlwaysClamp))
        weight *= std::exp2(stops) / before;
    tip("In stops: +1 is twice as bright. Ctrl+click to type; the colour is at the right");
    e.mark(mark + ".stops");
    ImGui::TableNextColumn();
    ImGui::BeginDisabled(!layer.tinted);
    const glm::vec3 color = weight / strength(weight);
    if (ImGui::ColorButton("##color", {color.x, color.y, color.z, 1}, ImGuiColorEditFlags_NoTooltip,
                           {ImGui::GetFrameHeight(), ImGui::GetFrameHeight()}))
        ImGui::OpenPopup("weight");
    ImGui::EndDisabled();
    tip(layer.tinted ? "Tint: multiplies the light's colour" : "Its colour is a texture, which is not tinted");
    e.mark(mark + ".color");
    weight_popup(e, weight, mark);
    ImGui::TableNextColumn();
    light_layer_buttons(e, layer.lights, mark);
    if (index >= e.panel_state->mixing.shares().size()) return;
    ImGui::TableNextColumn();
    share_cell(e, index, mark);
}

} // namespace

void draw_light_mixer(SelectContext& e) {
    LightMixing& mixing = e.panel_state->mixing;
    mixing.drawn();
    const auto layers = mixing.layers();
    if (layers.empty()) return empty_note("Nothing shines here. Lights are added in the panel Scene.");
    const std::uint32_t samples = mixing.samples();
    ImGui::BeginDisabled(!mixing.changed());
    if (flow_button("Apply", true)) mixing.apply(e);
    tip("The lights get these strengths and colours: one undo step");
    e.mark("mixer.apply");
    if (flow_button("Reset")) std::ranges::fill(mixing.weights, glm::vec3(1));
    tip("All lights as they are in the scene");
    e.mark("mixer.reset");
    ImGui::EndDisabled();
    ImGui::BeginDisabled(samples == 0);
    if (flow_button(mixing.spot ? "Another spot" : "Point at a spot")) e.pick_tool = spot_picker();
    tip("Click in the picture: how much each light brings there, and buttons to make that spot brighter");
    e.mark("mixer.spot");
    ImGui::EndDisabled();
    if (e.panel_state->lights.any()) {
        if (flow_button("All shine")) e.panel_state->lights.clear();
        tip("Ends all muting and soloing");
        e.mark("mixer.all");
    }
    if (samples == 0 && mixing.done())
        error_note("The lights could not be rendered: the Log says why.");
    else if (samples == 0)
        empty_note("Each light's own picture is being rendered; until then the live picture is shown.");
    else
        empty_note(fmt::format("The picture is a mix of {} light{}, {} sample{} per pixel each{}.", layers.size(),
                               layers.size() == 1 ? "" : "s", samples, samples == 1 ? "" : "s",
                               mixing.done() ? "" : ", still refined")
                       .c_str());
    if (mixing.shown()) e.mark("mixer.mixed");
    const bool spots = !mixing.shares().empty();
    if (!ImGui::BeginTable(spots ? "layers at spot" : "layers", spots ? 5 : 4, ImGuiTableFlags_SizingStretchProp))
        return;
    const float line = ImGui::GetFrameHeight();
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch, 1);
    ImGui::TableSetupColumn("stops", ImGuiTableColumnFlags_WidthStretch, 1.2f);
    ImGui::TableSetupColumn("color", ImGuiTableColumnFlags_WidthFixed, line);
    ImGui::TableSetupColumn("board", ImGuiTableColumnFlags_WidthFixed, 2 * line);
    if (spots) ImGui::TableSetupColumn("share", ImGuiTableColumnFlags_WidthFixed, 2.2f * line);
    for (std::size_t i = 0; i < std::min(layers.size(), mixing.weights.size()); ++i) {
        ImGui::PushID(int(i));
        layer_row(e, i, layers[i], mixing.weights[i]);
        ImGui::PopID();
    }
    ImGui::EndTable();
}

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
#include "light_buttons.hpp"

#include "document/session.hpp"
#include "io/material_emission.hpp"
#include "state.hpp"
#include "widgets.hpp"

#include <imgui.h>
#include <algorithm>
#include <vector>

namespace restage::editor {

namespace {

bool letter_button(const char* letter, bool on, float size, const char* tooltip) {
    if (on) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_HeaderActive));
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {0, 0});
    const bool pressed = ImGui::Button(letter, {size, ImGui::GetTextLineHeight()});
    ImGui::PopStyleVar();
    if (on) ImGui::PopStyleColor();
    tip(tooltip);
    return pressed;
}

std::vector<view::LightKey> selected_lights(const SelectContext& e) {
    if (e.selection.light()) return {view::key_of(e.selection.light())};
    std::vector<view::LightKey> keys;
    const io::MaterialEmissions emissions(e.registry(), e.scene());
    for (const InstanceId id : e.selection.instances())
        if (const scene::Instance* i = e.scene().instances.find(id); i && emissions.shines(*i))
            keys.push_back(view::key_of(id));
    return keys;
}

} // namespace

void light_row_end(PanelUi& e, view::LightKey key, const std::string& name, const char* kind) {
    view::LightBoard& board = e.panel_state->lights;
    const float scale = ImGui::GetStyle().FontScaleMain, size = ImGui::GetTextLineHeight() * 1.2f;
    const float end = ImGui::GetContentRegionAvail().x, gap = 3 * scale;
    ImGui::SameLine(end - 60 * scale - 2 * (size + gap));
    ImGui::TextDisabled("%s", kind);
    ImGui::SameLine(end - 2 * size - gap);
    if (letter_button("M", board.muted(key), size, "Mute: it does not shine in the view. Files are not changed"))
        board.mute(key, !board.muted(key));
    e.mark("lights.mute." + name);
    ImGui::SameLine(end - size);
    if (letter_button("S", board.soloed(key), size,
                      "Solo: in the view, only lights marked so shine. Files are not changed"))
        board.solo(key, !board.soloed(key));
    e.mark("lights.solo." + name);
}

void light_layer_buttons(PanelUi& e, std::span<const view::LightKey> keys, const std::string& mark) {
    view::LightBoard& board = e.panel_state->lights;
    const float size = ImGui::GetTextLineHeight() * 1.2f;
    const bool muted = std::ranges::all_of(keys, [&](view::LightKey key) { return board.muted(key); });
    const bool soloed = std::ranges::all_of(keys, [&](view::LightKey key) { return board.soloed(key); });
    ImGui::SetCursorPosY(ImGui::GetCursorPosY() + ImGui::GetStyle().FramePadding.y); // in the middle of a row of frames
    if (letter_button("M", muted, size, "Mute: it does not shine in the view. Files are not changed"))
        for (const view::LightKey key : keys)
            board.mute(key, !muted);
    e.mark(mark + ".mute");
    ImGui::SameLine(0, 3 * ImGui::GetStyle().FontScaleMain);
    if (letter_button("S", soloed, size, "Solo: in the view, only lights marked so shine. Files are not changed"))
        for (const view::LightKey key : keys)
            board.solo(key, !soloed);
    e.mark(mark + ".solo");
}

void light_board_note(PanelUi& e) {
    if (!e.panel_state->lights.any()) return;
    warning_note("Some lights are muted, only in the view.");
    if (ImGui::Button("All shine")) e.panel_state->lights.clear();
    tip("Ends all muting and soloing");
    e.mark("lights.all");
}

bool can_solo(const SelectContext& e) { return !selected_lights(e).empty(); }

void solo_selected(SelectContext& e) {
    view::LightBoard& board = e.panel_state->lights;
    const auto keys = selected_lights(e);
    const bool on = !std::ranges::all_of(keys, [&](view::LightKey key) { return board.soloed(key); });
    for (const view::LightKey key : keys)
        board.solo(key, on);
}

} // namespace restage::editor

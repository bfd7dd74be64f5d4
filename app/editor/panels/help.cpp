// SPDX-License-Identifier: Apache-2.0
// Help: navigation in the picture, and every shortcut from the table of actions, for the current key preset.
#include "panels.hpp"

#include "actions.hpp"
#include "panel_context.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <cctype>

namespace restage::editor {

namespace {

struct Gesture {
    const char* keys;
    const char* what;
    const char* blender; // null = the same
};
constexpr Gesture mouse[] = {
    {"Click", "Select; again: the object behind. Shift adds, Ctrl toggles", nullptr},
    {"Drag", "Select all in a box", nullptr},
    {"Double click", "Enter a group; elsewhere: orbit about that point", nullptr},
    {"Alt + drag", "Orbit, except on handles", "Middle drag, or Alt + drag"},
    {"Middle drag", "Pan", "Shift + middle drag"},
    {"Wheel", "Zoom to the point under the mouse", nullptr},
    {"Right drag", "Look around; with W A S D Q E: fly. Wheel: speed, Shift: faster", nullptr},
    {"Drag the selection", "Slides it horizontally. Shift: a copy, Ctrl: in steps; Alt during the drag: up and down",
     nullptr},
    {"Drag a box", "To the right: select objects entirely inside it. To the left: all that it touches", nullptr},
    {"Drag a handle", "Move, rotate or scale. Shift: a copy, Ctrl: in steps; moving with Alt: up and down", nullptr},
    {"Esc, right click in a drag", "Cancels the drag", nullptr},
    {"Right click on a value", "Back to its default", nullptr},
    {"Ctrl + click on a value", "Type a number", nullptr},
};

void heading(const char* text) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextColored(colors::accent, "%s", text);
    ImGui::TableNextColumn();
}

void line(const char* keys, const char* what) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    ImGui::TextUnformatted(keys);
    ImGui::TableNextColumn();
    ImGui::TextWrapped("%s", what);
}

bool begin_half(const char* id) {
    if (!ImGui::BeginTable(id, 2, ImGuiTableFlags_SizingStretchProp)) return false;
    ImGui::TableSetupColumn("keys", ImGuiTableColumnFlags_WidthFixed);
    ImGui::TableSetupColumn("what", ImGuiTableColumnFlags_WidthStretch);
    return true;
}

} // namespace

void draw_help(PanelUi& e, PictureView& picture) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("Keys as in");
    ImGui::SameLine();
    if (ImGui::RadioButton("Unity, Maya", picture.view.keys == KeyPreset::standard))
        picture.view.keys = KeyPreset::standard;
    e.mark("help.standard");
    ImGui::SameLine();
    if (ImGui::RadioButton("Blender", picture.view.keys == KeyPreset::blender)) picture.view.keys = KeyPreset::blender;
    e.mark("help.blender");
    ImGui::Separator();
    const bool blender = picture.view.keys == KeyPreset::blender;
    if (!ImGui::BeginTable("halves", 2,
                           ImGuiTableFlags_SizingStretchSame | ImGuiTableFlags_ScrollY | ImGuiTableFlags_BordersInnerV))
        return;
    ImGui::TableNextColumn();
    if (begin_half("left")) {
        heading("In the picture");
        for (const Gesture& g : mouse)
            line(blender && g.blender ? g.blender : g.keys, g.what);
        ImGui::EndTable();
    }
    ImGui::TableNextColumn();
    if (begin_half("right")) {
        std::string_view last;
        for (const Action& action : all_actions()) {
            const std::string_view id = action.id, menu = id.substr(0, id.find('.'));
            const std::string key = key_text(key_of(action, picture.view.keys));
            if (key.empty()) continue;
            if (menu != last) {
                std::string title(menu);
                title[0] = char(std::toupper(static_cast<unsigned char>(title[0])));
                heading(title.c_str());
                last = menu;
            }
            line(key.c_str(), fmt::format("{} - {}", action.label, action.tooltip).c_str());
        }
        ImGui::EndTable();
    }
    ImGui::EndTable();
}

} // namespace restage::editor

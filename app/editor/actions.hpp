// SPDX-License-Identifier: Apache-2.0
// Actions: everything a menu, a key or a button can do, by name. One table defines menus, shortcuts, the help page and
// the command palette; a button refers to an action by its id.
#pragma once

#include "preferences.hpp"

#include <imgui.h>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace restage::editor {

class EditContext;
class Editor;
class PanelContext;

struct Action {
    const char* id;       // "edit.undo"; the part before the dot is its menu
    const char* label;    // "Undo"
    ImGuiKeyChord key;    // 0 = none
    ImGuiKeyChord blender_key; // of the Blender-like preset; 0 = the same
    const char* tooltip;  // one sentence
    bool (*enabled)(const PanelContext&); // null = always
    void (*run)(Editor&);
    bool (*checked)(const PanelContext&) = nullptr; // null = not a toggle
};

std::span<const Action> all_actions();
const Action* find_action(std::string_view id);
ImGuiKeyChord key_of(const Action& action, KeyPreset preset);
std::string key_text(ImGuiKeyChord key); // "Ctrl+Z", "?"; "" = none
std::string label_of(const PanelContext& editor,
                     const Action& action); // including the edit it would undo: "Undo Move chair"

// Runs the actions of pressed keys, once per frame, except while text is typed or a dialog is open. `keys`: see
// Editor::frame.
void run_shortcuts(Editor& editor, const std::vector<ImGuiKeyChord>* keys);
// A menu entry, or a button, for that action, with its shortcut and tooltip.
void menu_item(EditContext& editor, std::string_view id);
bool action_button(EditContext& editor, std::string_view id, const char* label = nullptr);

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
// The panels: functions that draw the editor's state into a Dear ImGui window of their own and ask it for changes. To
// add one: a file here, a line here, a line in the table of panels.cpp.
#pragma once

#include "editor.hpp"

#include <span>

namespace restage::editor {

void draw_viewport(Editor& editor);
void draw_outliner(Editor& editor);
void draw_inspector(Editor& editor);
void draw_scene_settings(Editor& editor);
void draw_import_report(Editor& editor);
void draw_convergence(Editor& editor);
void draw_plugins(Editor& editor);
void draw_log(Editor& editor);
void draw_history(Editor& editor);

enum class Dock { center, left, right, bottom };

struct Panel {
    const char* title; // also its name in the layout file
    void (*draw)(Editor&); // between Begin and End
    Dock dock;         // where it is at first
    bool open;         // at first
    const char* tooltip;
};
std::span<const Panel> all_panels();

} // namespace restage::editor

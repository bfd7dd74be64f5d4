// SPDX-License-Identifier: Apache-2.0
// Widgets for a film's development, shared by the toolbar of the picture and the Scene panel.
#pragma once

#include "contexts.hpp"
#include "scene/scene.hpp"

namespace restage::editor {

// True if another curve was chosen. `mark`: of the list, and with ".agx" and so on of its entries.
bool tone_combo(PanelUi& editor, scene::Development& development, const char* mark);
// For the section of the sky, while none is visible: what is shown instead.
void backdrop_rows(EditContext& editor);
// One undo step, or part of that of the gesture.
void ask_development(EditContext& editor, const scene::Development& development, const char* label,
                     const char* gesture = "");

} // namespace restage::editor

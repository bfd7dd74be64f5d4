// SPDX-License-Identifier: Apache-2.0
// Pick tools: a click in the picture that gives something to a panel (a material, a distance) instead of selecting.
#pragma once

#include "selection.hpp"

#include <functional>
#include <string>

struct ImVec2;

namespace restage::editor {

class PanelContext;
class SelectContext;

// What the next click in the picture is for, instead of selecting. Esc cancels it.
struct PickTool {
    std::string hint; // "Click the object whose material to take"
    std::function<void(PanelContext&, InstanceId, ImVec2 screen)> done;
};

// Called by the viewport, before it picks. True while a tool is active: it takes the click. `over`: the mouse is
// free there.
// The object a click there means. Taken from the picture, which knows cut-outs, if a sharp one of the current scene
// is shown; else from the scene: a coarse picture would miss thin things.
InstanceId picked_at(const PanelContext& editor, ImVec2 screen);

bool run_pick_tool(PanelContext& editor, bool over);

// The material of what is clicked goes to the objects that are selected now.
PickTool material_eyedropper(const SelectContext& editor);
// What is clicked becomes sharp: the camera's focus distance.
PickTool focus_picker();

} // namespace restage::editor

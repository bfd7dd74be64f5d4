// SPDX-License-Identifier: Apache-2.0
// Pick tools: a click in the picture returns something to a panel (a material, a distance) instead of selecting.
#pragma once

#include "selection.hpp"

#include <functional>
#include <string>

struct ImVec2;

namespace restage::editor {

class PanelContext;
class SelectContext;

// The use of the next click in the picture, instead of selecting. Esc cancels it.
struct PickTool {
    std::string hint; // "Click the object whose material to take"
    std::function<void(PanelContext&, InstanceId, ImVec2 screen)> done;
};

// Called by the viewport, before it picks. True while a tool is active, which consumes the click. `over`: the mouse is
// not over anything else there.
// The object at that point. Taken from the picture, which accounts for cut-outs, if a sharp one of the current scene
// is shown; else from the scene, as a coarse picture would miss thin things.
InstanceId picked_at(const PanelContext& editor, ImVec2 screen);

bool run_pick_tool(PanelContext& editor, bool over);

// Assigns the material of the clicked object to the objects that are selected now.
PickTool material_eyedropper(const SelectContext& editor);
// Sets the camera's focus distance to the clicked point.
PickTool focus_picker();

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
// Placing a texture by eye: a frame on the surface, dragged inside to move the picture, at a corner to scale it, at the
// ring to turn it. All textures of the material with the same map follow. A gesture is one undo step.
#pragma once

#include "query/surface_site.hpp"
#include "scene/texture_map.hpp"
#include "selection.hpp"

#include <imgui.h>
#include <optional>
#include <utility>
#include <vector>

namespace restage::editor {

class EditContext;
class PanelContext;

struct TexturePlacing {
    bool on = false;
    query::SurfacePlace place; // the middle of the frame
    scene::Id<scene::Material> material;
    std::vector<scene::Id<scene::Texture>> textures; // the first one's map is shown
    double repeats = 1; // of the texture, on a side of the frame

    enum class Hold { none, inside, corner, ring } held = Hold::none;
    struct Grip { // at the start of a gesture
        std::vector<std::pair<scene::Id<scene::Texture>, scene::TextureMap>> maps;
        query::SurfaceSite site; // of the frame
        glm::dvec2 uv{0}; // under the mouse
        glm::dvec2 at{0}; // of the mouse in the frame's plane, from its middle
        ImVec2 offset{0, 0}; // from the mouse to the middle on screen
        double repeats = 1;
    } grip;
};

// Asks to place this texture, by the action "edit.place_texture".
void ask_to_place(EditContext& editor, scene::Id<scene::Texture> texture);
// On the active object, at a visible place of it. Without a texture that was asked for: the first one of its material
// that has a map. A notice says why it cannot be placed.
void begin_placing(PanelContext& editor);
void end_placing(PanelContext& editor);
// Called by the viewport before it picks: draws the frame, and true while the tool takes the mouse.
bool run_placing(PanelContext& editor, bool over);
// Reverts the running gesture.
void cancel_placing(PanelContext& editor);

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
// ViewSettings: display settings; not part of the document: never undone, and they never restart the picture.
#pragma once

#include "preferences.hpp"
#include "view/display.hpp"

#include <cstdint>

namespace restage::editor {

enum class GizmoMode { select, move, rotate, scale };

struct ViewSettings {
    view::DisplaySettings display;
    bool denoise = true;
    bool show_overlays = true; // outlines, gizmo, names
    bool show_panels = true; // Tab
    bool show_grid = false; // on the floor
    bool show_axes = true; // in the picture's corner
    bool inspect_pixels = false; // values under the mouse
    float resolution = 1; // picture pixels per screen pixel
    GizmoMode gizmo = GizmoMode::move;
    bool local_axes = false;
    float snap_move = 0.1f, snap_angle = 15, snap_scale = 0.1f; // scene units, deg, factor
    KeyPreset keys = KeyPreset::standard;
    bool camera_locked = true; // navigation moves only the view
    float fly_speed = 1; // multiple of a scene size per few seconds
    std::uint32_t samples = 0; // where the live picture stops; 0 = the scene's number
    double seconds = 0, error = 0;
};

} // namespace restage::editor

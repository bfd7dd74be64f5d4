// SPDX-License-Identifier: Apache-2.0
#include "panels.hpp"

#include <array>

namespace restage::editor {

namespace {

constexpr auto panels = std::to_array<Panel>({
    {"Viewport", draw_viewport, Dock::center, true, "The picture"},
    {"Outliner", draw_outliner, Dock::left, true, "Everything in the scene, by name"},
    {"Inspector", draw_inspector, Dock::right, true, "What is selected: its place, material and light"},
    {"Scene", draw_scene_settings, Dock::right, true, "Sky, camera, film and how it is rendered"},
    {"History", draw_history, Dock::bottom, true, "Every change, to go back to"},
    {"Import report", draw_import_report, Dock::bottom, true, "What was kept, approximated or dropped when opening"},
    {"Convergence", draw_convergence, Dock::bottom, true, "Estimated error against time and samples"},
    {"Plugins", draw_plugins, Dock::bottom, false, "What is loaded, from where, and what is not and why"},
    {"Assets", draw_assets, Dock::bottom, true, "Scenes, skies, textures and meshes to bring in"},
    {"Log", draw_log, Dock::bottom, true, "What happened"},
    {"Help", draw_help, Dock::floating, false, "Every shortcut, and how to get around"},
});

} // namespace

std::span<const Panel> all_panels() { return panels; }

} // namespace restage::editor

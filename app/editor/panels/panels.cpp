// SPDX-License-Identifier: Apache-2.0
#include "panels.hpp"

#include "panel_context.hpp"

#include <array>

namespace restage::editor {

namespace {

// Calls the panel with the parts of the context in its parameters.
template <auto draw>
void give(PanelContext& e) {
    [&]<class... Parts>(void (*panel)(Parts&...)) { panel(static_cast<Parts&>(e)...); }(draw);
}

constexpr auto panels = std::to_array<Panel>({
    {"Viewport", draw_viewport, Dock::center, true, "The picture"},
    {"Outliner", give<draw_outliner>, Dock::left, true, "Everything in the scene, by name"},
    {"Inspector", give<draw_inspector>, Dock::right, true, "The selection: its place, material and light"},
    {"Scene", give<draw_scene_settings>, Dock::right, true, "Sky, camera, film and rendering"},
    {"Arrange", give<draw_arrange>, Dock::right, false, "Align, distribute, mirror, repeat and replace the selection"},
    {"Light mixer", give<draw_light_mixer>, Dock::right, false,
     "A fader for each light: the picture follows without being rendered again"},
    {"History", give<draw_history>, Dock::bottom, true, "Every change, to go back to"},
    {"Looks", give<draw_looks>, Dock::bottom, true, "Named variations of the scene, and pictures to compare"},
    {"Import report", give<draw_import_report>, Dock::bottom, true,
     "What was kept, approximated or dropped on opening"},
    {"Convergence", give<draw_convergence>, Dock::bottom, true, "Estimated error against time and samples"},
    {"Statistics", give<draw_statistics>, Dock::bottom, false, "What the scene holds, time and memory of the picture"},
    {"Plugins", give<draw_plugins>, Dock::bottom, false,
     "Loaded plugins and their folders, and why others are not loaded"},
    {"Assets", give<draw_assets>, Dock::bottom, true, "Scenes, skies, textures and meshes to add"},
    {"Materials", give<draw_materials>, Dock::bottom, true, "Balls of materials, to click or drag onto objects"},
    {"Log", give<draw_log>, Dock::bottom, true, "What happened"},
    {"Help", give<draw_help>, Dock::floating, false, "All shortcuts, and how to navigate"},
});

} // namespace

std::span<const Panel> all_panels() { return panels; }

} // namespace restage::editor

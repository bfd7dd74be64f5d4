// SPDX-License-Identifier: Apache-2.0
// The command palette: a field that finds every action, panel, object, group, light, material and camera by a part of
// its name.
#pragma once

#include "name_search.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace restage::editor {

class PanelContext;

struct PaletteItem {
    enum class Kind : std::uint8_t { action, plugin_action, panel, object, group, light, material, camera };
    Kind kind = Kind::action;
    std::uint32_t id = 0; // of the scene's things their Id::value, of others their place in their table
};

struct PaletteState {
    bool asked = false; // to be opened in this frame
    bool focus = false; // of the field, in the next frame
    std::string query, found_query;
    std::vector<PaletteItem> items;
    NameList names; // of the items
    std::uint64_t made_for = 0; // the scene's clock
    std::vector<std::uint32_t> found; // numbers of items, the best first
    int cursor = 0; // in `found`
    bool follow_cursor = false; // scroll to it
    std::vector<std::string> recent; // what was chosen last, the latest first
};

// Draws it if it is open. Call once per frame, after the panels.
void draw_palette(PanelContext& editor);

} // namespace restage::editor

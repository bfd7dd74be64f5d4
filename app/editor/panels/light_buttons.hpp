// SPDX-License-Identifier: Apache-2.0
// Mute and solo of lights in the live picture: view/light_board.hpp. Neither changes the document.
#pragma once

#include "contexts.hpp"
#include "view/light_board.hpp"

#include <span>

namespace restage::editor {

// The end of a light's row in a list: what it is, and its buttons M and S. Call after the item that starts the row.
void light_row_end(PanelUi& editor, view::LightKey key, const std::string& name, const char* kind);
// Buttons M and S alone, which concern all of these lights; marked mark + ".mute" and mark + ".solo".
void light_layer_buttons(PanelUi& editor, std::span<const view::LightKey> keys, const std::string& mark);
// While some lights are muted or soloed: says so, with a button that ends it.
void light_board_note(PanelUi& editor);

// Solos the selected light or emitting objects, or, if they are soloed, no longer.
void solo_selected(SelectContext& editor);
bool can_solo(const SelectContext& editor);

} // namespace restage::editor

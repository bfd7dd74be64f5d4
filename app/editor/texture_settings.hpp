// SPDX-License-Identifier: Apache-2.0
// The settings of the texture in a slot: its type, its parameters as rows like a material's, and its operands with
// their textures.
#pragma once

#include "param_widget.hpp"
#include "scene/edits_texture.hpp"

namespace restage::editor {

// Draws the rows; each requests its own edits.
void texture_settings(EditContext& editor, scene::Id<scene::Texture> texture, const std::string& mark);

// Requests the edit for a change to a parameter. `gesture`: the gesture its value changes belong to, which form one
// undo step until the control is released.
void carry_out(EditContext& editor, const scene::TextureSlot& slot, const ParamAsk& ask, const std::string& gesture);

} // namespace restage::editor

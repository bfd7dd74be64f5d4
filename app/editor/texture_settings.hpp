// SPDX-License-Identifier: Apache-2.0
// What is in a texture slot: its type, its parameters as rows like a material's, its operands with what is in them.
#pragma once

#include "param_widget.hpp"
#include "scene/edits_texture.hpp"

namespace restage::editor {

// Rows that ask for edits themselves.
void texture_settings(EditContext& editor, scene::Id<scene::Texture> texture, const std::string& mark);

// Asks for the edit of what the user asked of a parameter. `gesture`: of changes of its value, which are one step
// until released.
void carry_out(EditContext& editor, const scene::TextureSlot& slot, const ParamAsk& ask, const std::string& gesture);

} // namespace restage::editor

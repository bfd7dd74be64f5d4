// SPDX-License-Identifier: Apache-2.0
// The widget of one parameter that a plugin declares, made from its table line, and of a texture that replaces it.
#pragma once

#include "scene/scene.hpp"

#include <optional>
#include <string>

namespace restage::plugin {
class TableReader;
}

namespace restage::editor {

class EditContext;
class PanelUi;

struct ParamAsk { // the user's request; mostly empty
    std::optional<scene::Value> value;
    bool reset = false; // back to the table's default
    std::string image_file; // a texture of this image
    std::string new_texture; // a texture of this type
};

struct SlotRules { // of a slot that new textures may be made for
    bool scalar = false; // reads one channel
    scene::Id<scene::Texture> inside; // operand of this texture, which it must not contain
};

// A row: label, range, unit and tooltip are the table's. A right click offers the default. `mark` names it for tests.
// `reader`: of the files of model::ParamType::table parameters, for what is wrong with one. `rules`: null if the caller
// takes neither new textures nor image files.
ParamAsk param_widget(EditContext& editor, const model::Param& line, const scene::Value& value, bool is_set,
                      const std::string& mark, const plugin::TableReader* reader = nullptr,
                      const SlotRules* rules = nullptr);

// A colour that is stored linear and chosen in sRGB. True when changed.
bool color_field(const char* id, float* linear, bool hdr = false);

// A menu entry that asks for an image file in the file browser, which replaces the menu.
void image_file_item(EditContext& editor, const std::string& mark);
// The file that was chosen there for this mark, once; else "".
std::string chosen_image_file(PanelUi& editor, const std::string& mark);

} // namespace restage::editor

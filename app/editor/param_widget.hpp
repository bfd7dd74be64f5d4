// SPDX-License-Identifier: Apache-2.0
// The widget of one parameter, built from its line in the plugin's table, and of a texture that replaces it.
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

struct ParamAsk { // the user's request; usually empty
    std::optional<scene::Value> value;
    bool reset = false; // back to the table's default
    std::string image_file; // a texture of this image
    std::string new_texture; // a texture of this type
};

struct SlotRules { // of a slot for which new textures may be created
    bool scalar = false; // reads one channel
    scene::Id<scene::Texture> inside; // operand of this texture, which must not be among its own operands
};

// A row: label, range, unit and tooltip are the table's. A right click offers the default. `mark`: its name for tests.
// `reader`: for errors in files of model::ParamType::table parameters. `rules`: null if the caller
// accepts neither new textures nor image files.
ParamAsk param_widget(EditContext& editor, const model::Param& line, const scene::Value& value, bool is_set,
                      const std::string& mark, const plugin::TableReader* reader = nullptr,
                      const SlotRules* rules = nullptr);

// The values that the table accepts.
scene::ParamSet fitting(model::ParamTable table, const scene::ParamSet& values);

// A colour stored as linear and chosen in sRGB. True if changed.
bool color_field(const char* id, float* linear, bool hdr = false);

// A menu entry for choosing an image file in the file browser, which replaces the menu.
void image_file_item(EditContext& editor, const std::string& mark);
// The file chosen there for this mark, returned once; else "".
std::string chosen_image_file(PanelUi& editor, const std::string& mark);

} // namespace restage::editor

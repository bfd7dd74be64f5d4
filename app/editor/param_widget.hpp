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

class PanelContext;

struct ParamAsk { // the user's request; mostly empty
    std::optional<scene::Value> value;
    bool reset = false; // back to the table's default
    std::string image_file; // a texture of this image
};

// A row: label, range, unit and tooltip are the table's. A right click offers the default. `mark` names it for tests.
// `reader`: of the files of model::ParamType::table parameters, for what is wrong with one.
ParamAsk param_widget(PanelContext& editor, const model::Param& line, const scene::Value& value, bool is_set,
                      const std::string& mark, const plugin::TableReader* reader = nullptr);

// Scale, wrap, inversion and placing of an image texture, as rows that ask for edits themselves.
void texture_settings(PanelContext& editor, scene::Id<scene::Texture> texture, const std::string& mark);

// A colour that is stored linear and chosen in sRGB. True when changed.
bool color_field(const char* id, float* linear, bool hdr = false);

// A menu entry that asks for an image file in the file browser, which replaces the menu.
void image_file_item(PanelContext& editor, const std::string& mark);
// The file that was chosen there for this mark, once; else "".
std::string chosen_image_file(PanelContext& editor, const std::string& mark);

} // namespace restage::editor

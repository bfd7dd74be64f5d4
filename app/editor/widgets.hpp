// SPDX-License-Identifier: Apache-2.0
// Widgets made from tables: one for each type of parameter a plugin can declare.
#pragma once

#include "scene/params.hpp"

#include <optional>
#include <string>

namespace restage::editor {

class Editor;

// The widget of a parameter: label, range, unit and tooltip are the table's. The new value, when the user changed it.
// `mark` names it for tests.
std::optional<scene::Value> param_widget(Editor& editor, const RestageParam& line, const scene::Value& value,
                                         const std::string& mark);

} // namespace restage::editor

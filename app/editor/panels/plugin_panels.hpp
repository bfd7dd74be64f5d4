// SPDX-License-Identifier: Apache-2.0
// Panels of plugins (restage/action.h). Their values are not part of a document: they are stored in the configuration
// folder.
#pragma once

#include "contexts.hpp"
#include "plugin/registry.hpp"

#include <string>

namespace restage::editor {

// Key of its window, and in the table of open panels, as labels need not be unique among plugins.
std::string panel_title(const model::Panel& panel);
void draw_panel(SelectContext& editor, const plugin::PanelEntry& panel); // between Begin and End

} // namespace restage::editor

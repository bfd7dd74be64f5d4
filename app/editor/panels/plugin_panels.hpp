// SPDX-License-Identifier: Apache-2.0
// Panels of plugins (restage/action.h). Their values are no part of a document: they are remembered in the
// configuration folder.
#pragma once

#include "contexts.hpp"
#include "plugin/registry.hpp"

#include <string>

namespace restage::editor {

// Of its window, and in the table of those that are open: another plugin's may have the same label.
std::string panel_title(const model::Panel& panel);
void draw_panel(SelectContext& editor, const plugin::PanelEntry& panel); // between Begin and End

} // namespace restage::editor

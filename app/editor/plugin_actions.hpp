// SPDX-License-Identifier: Apache-2.0
// Actions of plugins (restage/action.h) in the editor: a menu, a dialog for those with parameters, and background runs,
// whose results are one undo step each.
#pragma once

#include "contexts.hpp"
#include "plugin/registry.hpp"
#include "scene/params.hpp"

namespace restage::editor {

// "" or why it cannot run now: another action is running, or nothing is selected.
std::string why_not_now(const SelectContext& e, const model::Action& action);
// Runs it on the selection. Its new objects are selected afterwards.
void start_action(SelectContext& e, const plugin::ActionEntry& entry, scene::ParamSet values);
// Opens a dialog for its parameters first, if it has any.
void ask_for_action(SelectContext& e, const plugin::ActionEntry& entry);
// The Tools menu, within the menu bar; omitted if no plugin provides an action.
void tools_menu(SelectContext& e);

} // namespace restage::editor

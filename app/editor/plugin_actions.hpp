// SPDX-License-Identifier: Apache-2.0
// Actions of plugins (restage/action.h) in the editor: a menu, a dialog for those with parameters, and the run in the
// background, whose result is one step of the history.
#pragma once

#include "contexts.hpp"
#include "plugin/registry.hpp"
#include "scene/params.hpp"

namespace restage::editor {

// "" or why it cannot run now: another one runs, or nothing is selected.
std::string why_not_now(const SelectContext& e, const model::Action& action);
// Runs it over what is selected. Its new objects are selected afterwards.
void start_action(SelectContext& e, const plugin::ActionEntry& entry, scene::ParamSet values);
// Asks for its parameters first, where it has some.
void ask_for_action(SelectContext& e, const plugin::ActionEntry& entry);
// The menu "Tools", between others in the menu bar; nothing where no plugin brings an action.
void tools_menu(SelectContext& e);

} // namespace restage::editor

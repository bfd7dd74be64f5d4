// SPDX-License-Identifier: Apache-2.0
// Actions of plugins on an open document: they read a copy of its scene on any thread, and their edits become one undo
// step, if nothing that they touch has changed meanwhile.
#pragma once

#include "document/session.hpp"
#include "io/run_action.hpp"

namespace restage::document {

struct ActionDone {
    bool changed = false; // false: the action had nothing to do
    std::vector<scene::Id<scene::Instance>> selection; // the new selection
    io::Report report;
};

// [main] Rebases the result of run_action for an earlier state of the document onto the current one.
Result<> rebase_action(const scene::Scene& now, io::ActionResult&);

// [main] Applies the result of run_action (io/run_action.hpp) for an earlier state of the document. Refused as a whole
// if a thing that it changes or refers to has since been changed or removed, or if another document is open. New things
// get different ids if theirs are in use by now.
Result<ActionDone> apply_action(Session&, io::ActionResult);

// [main] Runs and applies an action, for scripts and commands. `id`: "scatter".
Result<plugin::ActionEntry> find_action(const plugin::Registry&, std::string_view id);
Result<ActionDone> run_action(Session&, std::string_view id, const io::ActionRun&);

} // namespace restage::document

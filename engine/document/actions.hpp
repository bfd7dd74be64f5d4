// SPDX-License-Identifier: Apache-2.0
// Actions of plugins over an open document: they read a copy of its scene on any thread, and what they return becomes
// one step of its history, if nothing it touches has changed meanwhile.
#pragma once

#include "document/session.hpp"
#include "io/run_action.hpp"

namespace restage::document {

struct ActionDone {
    bool changed = false; // false: the action had nothing to do
    std::vector<scene::Id<scene::Instance>> selection; // what is to be selected
    io::Report report;
};

// [main] Moves what run_action made of an earlier state of the document onto the present one.
Result<> rebase_action(const scene::Scene& now, io::ActionResult&);

// [main] Takes what run_action (io/run_action.hpp) made of an earlier state of the document. Refused, whole, where a
// thing that it changes or refers to was changed or removed since, or another document is open. New things get other
// ids than they had where somebody else has taken those.
Result<ActionDone> apply_action(Session&, io::ActionResult);

// [main] All of it, for scripts and commands. `id`: "scatter".
Result<plugin::ActionEntry> find_action(const plugin::Registry&, std::string_view id);
Result<ActionDone> run_action(Session&, std::string_view id, const io::ActionRun&);

} // namespace restage::document

// SPDX-License-Identifier: Apache-2.0
// Runs an action of a plugin (restage/action.h) on a scene without changing it: the result is data.
#pragma once

#include "base/jobs.hpp"
#include "base/result.hpp"
#include "io/report.hpp"
#include "plugin/registry.hpp"
#include "scene/edit.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace restage::io {

struct ActionRun {
    std::vector<scene::Id<scene::Instance>> selection; // the last is the active one
    scene::ParamSet values; // of the action's table; unset ones take the default
    Progress progress;      // may be empty
    Jobs* jobs = nullptr;   // for decoding images; null = a private pool
    std::uint64_t* late = nullptr; // receives the number of changes made after progress() returned false
};

struct ActionResult {
    scene::Edit edit; // from `base`, with the action's label; empty if it had nothing to do
    std::vector<scene::Id<scene::Instance>> selection; // the selection afterwards
    Report report; // the action's report lines, and refused changes
    scene::Scene base; // the scene that the action read
};

// Parts of errors that are the plugin's fault, not the user's.
inline constexpr std::string_view no_reason = "failed without giving a reason";
inline constexpr std::string_view threw = "threw an exception";
inline constexpr std::string_view unsound = "its edits are invalid";

// Why the action cannot run with this selection and these values; checked by run_action, too.
Result<> check_action_run(const scene::Scene&, const model::Action&, const ActionRun&);

// [worker] or [main]. An exception in the plugin becomes an error.
Result<ActionResult> run_action(const scene::Scene&, const plugin::Registry&, const plugin::ActionEntry&,
                                const ActionRun&);

// The first error of validate() that `before` does not have; "" if there is none.
std::string new_error(const scene::Scene& before, const scene::Scene& after);

} // namespace restage::io

// SPDX-License-Identifier: Apache-2.0
// Runs an action of a plugin (restage/action.h) over a scene, which stays as it is: the result is data.
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
    scene::ParamSet values; // of the action's table; what is not set has the table's default
    Progress progress;      // may be empty
    Jobs* jobs = nullptr;   // for decoding images; null = a pool of its own
    std::uint64_t* late = nullptr; // becomes the number of changes it made after progress() had said stop
};

struct ActionResult {
    scene::Edit edit; // from `base`; has the action's label; no changes = it had nothing to do
    std::vector<scene::Id<scene::Instance>> selection; // what is to be selected afterwards
    Report report; // what the action said, and what was refused
    scene::Scene base; // what the action has read
};

// Parts of errors that are the plugin's fault, not the user's.
inline constexpr std::string_view no_reason = "failed and gave no reason";
inline constexpr std::string_view threw = "threw an exception";
inline constexpr std::string_view unsound = "what it returns is not a sound scene";

// Why the action cannot run with this selection and these values; checked by run_action, too.
Result<> check_action_run(const scene::Scene&, const model::Action&, const ActionRun&);

// [worker] or [main]. An exception of the plugin becomes an error.
Result<ActionResult> run_action(const scene::Scene&, const plugin::Registry&, const plugin::ActionEntry&,
                                const ActionRun&);

// The first error of validate() that `before` does not have, or "".
std::string new_error(const scene::Scene& before, const scene::Scene& after);

} // namespace restage::io

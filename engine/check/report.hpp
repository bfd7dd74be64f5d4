// SPDX-License-Identifier: Apache-2.0
// Reports as text, JSON, JUnit XML and Markdown.
#pragma once

#include "base/result.hpp"
#include "check/step.hpp"

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>

namespace restage::check {

nlohmann::ordered_json to_json(const StepResult&);
StepResult step_from_json(const nlohmann::ordered_json&);
nlohmann::ordered_json to_json(const PluginReport&);

std::string headline(const PluginReport&);                  // "org.restage.material.diffuse 0.1.0 (material, seed 1)"
std::string text_of(const StepResult&, const PluginReport&); // one line, or several if it failed
std::string verdict_line(const PluginReport&);              // "passed: 14 passed, 3 skipped, 41.2 s"

std::string junit(std::span<const PluginReport>);
// Table of plugins and steps with figures: docs/conformance.md.
std::string markdown(std::span<const PluginReport>);

} // namespace restage::check

// SPDX-License-Identifier: Apache-2.0
// Command line diagnostics: values that no option accepts, and error messages.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace restage::app {

// For the options of all commands: values must not be empty, and numbers must be finite.
void forbid_empty_values(CLI::App& program);
// The error, and where to find help.
std::string usage_sentence(const CLI::App& program, const CLI::Error&);

} // namespace restage::app

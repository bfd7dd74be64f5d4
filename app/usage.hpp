// SPDX-License-Identifier: Apache-2.0
// Command line diagnostics: values that no option accepts, and mistakes as sentences.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace restage::app {

// No value may be empty, and no number NaN or infinite, of any command's options.
void forbid_empty_values(CLI::App& program);
// What was wrong, and where help is.
std::string usage_sentence(const CLI::App& program, const CLI::Error&);

} // namespace restage::app

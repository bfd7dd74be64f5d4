// SPDX-License-Identifier: Apache-2.0
#include "commands.hpp"
#include <CLI/CLI.hpp>
namespace restage::app {
void add_demo(CLI::App&, Context&) {}
} // namespace restage::app

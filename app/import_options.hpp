// SPDX-License-Identifier: Apache-2.0
// --import-set of commands that open a scene: options of its importer.
#pragma once

#include "context.hpp"
#include "io/import.hpp"

#include <CLI/CLI.hpp>
#include <span>
#include <string>
#include <vector>

namespace restage::document {
struct Looks;
}

namespace restage::app {

void add_import_options(CLI::App& command, std::vector<std::string>& assignments);

// open_scene (rendering.hpp) with assignments like "up=z".
Result<io::ImportedScene> open_scene_with(Context& context, const std::string& path, bool strict,
                                          std::span<const std::string> assignments, document::Looks* looks = nullptr);

} // namespace restage::app

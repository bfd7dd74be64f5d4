// SPDX-License-Identifier: Apache-2.0
// Option tables of importers and exporters: validation, parsing of command lines, and values for the plugin.
#pragma once

#include "base/result.hpp"
#include "model/formats.hpp"
#include "plugin/registry.hpp"
#include "scene/params.hpp"

#include <string>

namespace restage::io {

// `who`: 'importer "obj"'. Refused: options that are not in the table, invalid values.
Result<> check_option(const std::string& who, model::ParamTable, const std::string& id, const scene::Value&);
// Parses "up=z" according to the table.
Result<> set_option(const std::string& who, model::ParamTable, const std::string& assignment, scene::ParamSet& values);
// Every option in the table's order, set or default.
scene::ParamSet all_options(model::ParamTable, const scene::ParamSet& values);

// The importer that would read the file. `format`: of one importer; "" = try all.
Result<plugin::ImporterEntry> importer_of(const std::string& path, const plugin::Registry&,
                                          const std::string& format = {});
// Parses "up=z" of a command line according to the importer's table.
Result<> set_option(const model::Importer&, const std::string& assignment, scene::ParamSet& values);
// Likewise without the importer: a text, for fitting_options.
Result<> set_text_option(const std::string& assignment, scene::ParamSet& values);
// The value as the right-hand side of an assignment.
std::string option_text(const scene::Value&);
// A value converted to the type of the table's line: text is accepted for any type, integers for other numbers.
Result<scene::Value> fitting_option(const model::Importer&, const std::string& id, const scene::Value&);
Result<scene::ParamSet> fitting_options(const model::Importer&, const scene::ParamSet&);

} // namespace restage::io

// SPDX-License-Identifier: Apache-2.0
// Option tables of importers and exporters: what is refused, what a command line says, what the plugin is given.
#pragma once

#include "base/result.hpp"
#include "model/formats.hpp"
#include "plugin/registry.hpp"
#include "scene/params.hpp"

#include <string>

namespace restage::io {

// `who`: 'importer "obj"'. Refused: an option that the table does not have, a value that does not fit.
Result<> check_option(const std::string& who, model::ParamTable, const std::string& id, const scene::Value&);
// "up=z", after the table.
Result<> set_option(const std::string& who, model::ParamTable, const std::string& assignment, scene::ParamSet& values);
// Every option in the table's order, set or default.
scene::ParamSet all_options(model::ParamTable, const scene::ParamSet& values);

// Who would read the file. `format`: of one importer; "" = ask all of them.
Result<plugin::ImporterEntry> importer_of(const std::string& path, const plugin::Registry&,
                                          const std::string& format = {});
// "up=z" of a command line, after the importer's table.
Result<> set_option(const model::Importer&, const std::string& assignment, scene::ParamSet& values);
// The same without knowing the importer: a text, for fitting_options.
Result<> set_text_option(const std::string& assignment, scene::ParamSet& values);
// The value as the right-hand side of an assignment.
std::string option_text(const scene::Value&);
// A value as the table's line takes it: text stands for any type, whole numbers for others.
Result<scene::Value> fitting_option(const model::Importer&, const std::string& id, const scene::Value&);
Result<scene::ParamSet> fitting_options(const model::Importer&, const scene::ParamSet&);

} // namespace restage::io

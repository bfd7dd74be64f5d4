// SPDX-License-Identifier: Apache-2.0
// Strict reading and writing: what would be a line of a report is an error.
#pragma once

#include "io/export.hpp"
#include "io/import.hpp"

namespace restage::io {

// Of an import: an error that lists what was approximated or dropped, if anything was.
Result<> refuse_losses(const Report&, const std::string& path);

// As export_scene, but nothing is written when the format cannot hold all of the scene. It is written twice: first into
// a temporary folder, to see.
Result<Report> export_strictly(const scene::Scene&, const std::string& path, const plugin::Registry&,
                               ExportOptions = {});

// As export_strictly; what the import approximated or dropped counts as well, unless the written file has it: its
// import, which is tried, says the same of it. (A texture that is not rendered is approximated in the picture, and in
// the file.)
Result<Report> convert_strictly(const ImportedScene&, const std::string& path, const plugin::Registry&,
                                ExportOptions = {});

} // namespace restage::io

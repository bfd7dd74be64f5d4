// SPDX-License-Identifier: Apache-2.0
// Strict reading and writing: what would be a report line is an error.
#pragma once

#include "io/export.hpp"
#include "io/import.hpp"

namespace restage::io {

// For an import: an error that lists what was approximated or dropped, if anything.
Result<> refuse_losses(const Report&, const std::string& path);

// Like export_scene, but nothing is written if the format cannot hold the whole scene. It is written twice: first into
// a temporary folder, as a trial.
Result<Report> export_strictly(const scene::Scene&, const std::string& path, const plugin::Registry&,
                               ExportOptions = {});

// Like export_strictly; what the import approximated or dropped counts too, unless the written file has it: its
// trial import reports the same. (A texture that is not rendered is approximated in the picture, but complete in
// the file.)
Result<Report> convert_strictly(const ImportedScene&, const std::string& path, const plugin::Registry&,
                                ExportOptions = {});

} // namespace restage::io

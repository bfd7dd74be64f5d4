// SPDX-License-Identifier: Apache-2.0
// Writes a Scene to a file: the exporter is chosen by name or by the file's extension.
#pragma once

#include "base/result.hpp"
#include "io/report.hpp"
#include "plugin/registry.hpp"
#include "scene/scene.hpp"

#include <string>

namespace restage::io {

struct ExportOptions {
    Progress progress;      // may be empty
    std::string format;     // of one exporter; "" = by the extension of the path
    scene::ParamSet values; // of the exporter's option table; unset ones take the table's default
};

// Refuses a scene with errors (validate), unknown options and choices. A failed export leaves the old file intact.
Result<Report> export_scene(const scene::Scene&, const std::string& path, const plugin::Registry&,
                            const ExportOptions& = {});

// Parses "version=v3" from a command line, per the exporter's table.
Result<> set_option(const model::Exporter&, const std::string& assignment, scene::ParamSet& values);
Result<plugin::ExporterEntry> find_exporter(const std::string& path, const std::string& format,
                                            const plugin::Registry&);

} // namespace restage::io

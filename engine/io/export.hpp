// SPDX-License-Identifier: Apache-2.0
// A Scene becomes a file: the exporter is chosen by name or by the file's extension.
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
    scene::ParamSet values; // of the exporter's option table; what is not set has the table's default
};

// Refuses a scene with errors (validate), unknown options and choices. An export that fails leaves the old file.
Result<Report> export_scene(const scene::Scene&, const std::string& path, const plugin::Registry&,
                            const ExportOptions& = {});

// "version=v3" of a command line, after the exporter's table.
Result<> set_option(const model::Exporter&, const std::string& assignment, scene::ParamSet& values);
Result<plugin::ExporterEntry> find_exporter(const std::string& path, const std::string& format,
                                            const plugin::Registry&);

} // namespace restage::io

// SPDX-License-Identifier: Apache-2.0
// Reads a file into a Scene with the most confident importer. Three outcomes: the format is unknown,
// the file is broken (file:line:column), or a scene with a report.
#pragma once

#include "base/jobs.hpp"
#include "base/result.hpp"
#include "io/report.hpp"
#include "plugin/registry.hpp"
#include "scene/scene.hpp"

#include <string>

namespace restage::io {

struct ImportOptions {
    Progress progress;      // may be empty
    std::string format;     // of one importer; "" = try all
    Jobs* jobs = nullptr;   // for decoding images; null = a private pool
    bool read_images = true;
    scene::ParamSet values; // of the importer's option table, or as text; unset ones take the table's default
};

struct ImportedScene {
    scene::Scene scene;
    Report report;
    std::string importer; // its format: "pbrt"
    bool unexposed = false; // the file gives no exposure, and its light has units: document/exposure.hpp meters
    scene::ParamSet options{}; // of the importer: those that were set
};

// 0..100: the importer's confidence that a file with this head is of its format; returned unchecked.
int probe(const plugin::ImporterEntry&, const std::string& path, std::string_view head);

Result<ImportedScene> import_scene(const std::string& path, const plugin::Registry&, const ImportOptions& = {});

} // namespace restage::io

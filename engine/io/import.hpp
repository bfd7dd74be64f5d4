// SPDX-License-Identifier: Apache-2.0
// A file becomes a Scene: the importer that is surest of the file reads it. Three outcomes: nobody knows the format,
// somebody does but the file is broken (file:line:column), or a scene with a report.
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
    std::string format;     // of one importer; "" = ask all of them
    Jobs* jobs = nullptr;   // for decoding images; null = a pool of its own
    bool read_images = true;
    scene::ParamSet values; // of the importer's option table; what is not set has the table's default
};

struct ImportedScene {
    scene::Scene scene;
    Report report;
    std::string importer; // its format: "pbrt"
    bool unexposed = false; // the file says nothing of exposure, and its light has units: document/exposure.hpp meters
};

// 0..100: how sure the importer is that a file that begins so is its own; what it answers is not judged.
int probe(const plugin::ImporterEntry&, const std::string& path, std::string_view head);

Result<ImportedScene> import_scene(const std::string& path, const plugin::Registry&, const ImportOptions& = {});

} // namespace restage::io

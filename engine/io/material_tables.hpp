// SPDX-License-Identifier: Apache-2.0
// Tables of a scene's material plugins: their files (restage/table.h) are read when the scene is opened (a material
// with an unreadable one is shown as grey, and reported), and values are checked against them.
#pragma once

#include "io/report.hpp"
#include "plugin/registry.hpp"
#include "scene/edit.hpp"
#include "scene/scene.hpp"

namespace restage::io {

// One report line per table that is set. Materials equal to those in `already` were reported before.
void report_tables(const scene::Scene& scene, const plugin::Registry& registry, Report& report,
                   const scene::Scene* already = nullptr);

// Sets a parameter, checked against the table of the material's plugin: type, range, choices. Unknown ids are refused;
// a material whose plugin is missing accepts any.
Result<scene::Edit> param_edit(const scene::Scene&, const plugin::Registry&, scene::Id<scene::Material>,
                               std::string_view param, scene::Value);

} // namespace restage::io

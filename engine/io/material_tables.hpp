// SPDX-License-Identifier: Apache-2.0
// What a scene has from the tables of its material plugins: files that materials look up (restage/table.h), tried as it
// is opened (what cannot be read shows as grey, and the report says so), and values that fit.
#pragma once

#include "io/report.hpp"
#include "plugin/registry.hpp"
#include "scene/edit.hpp"
#include "scene/scene.hpp"

namespace restage::io {

// One report line per table that is set. Materials equal to those in `already` were reported before.
void report_tables(const scene::Scene& scene, const plugin::Registry& registry, Report& report,
                   const scene::Scene* already = nullptr);

// Sets a parameter, held to the table of the material's plugin: type, range, choices. Unknown ids are refused; a
// material whose plugin is missing takes any.
Result<scene::Edit> param_edit(const scene::Scene&, const plugin::Registry&, scene::Id<scene::Material>,
                               std::string_view param, scene::Value);

} // namespace restage::io

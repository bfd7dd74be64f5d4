// SPDX-License-Identifier: Apache-2.0
// Tables that materials look up (restage/table.h), tried as a scene is opened: what cannot be read shows as grey, and
// the report says so.
#pragma once

#include "io/report.hpp"
#include "plugin/registry.hpp"
#include "scene/scene.hpp"

namespace restage::io {

// One line of the report a table that is set. Materials that are the same in `already` were reported with it.
void report_tables(const scene::Scene& scene, const plugin::Registry& registry, Report& report,
                   const scene::Scene* already = nullptr);

} // namespace restage::io

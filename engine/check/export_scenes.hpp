// SPDX-License-Identifier: Apache-2.0
// Test scenes for exporters.
#pragma once

#include "model/formats.hpp"
#include "scene/scene.hpp"

#include <vector>

namespace restage::check {

// Every kind of thing; names with spaces, quotes and non-ASCII letters; holes where things were removed.
scene::Scene everything_scene();
scene::Scene empty_scene(); // only a camera
scene::Scene geometry_scene(); // three objects of one mesh, at different places

// The defaults, then every choice of every option, one at a time.
std::vector<scene::ParamSet> option_sets(const model::Exporter&);

} // namespace restage::check

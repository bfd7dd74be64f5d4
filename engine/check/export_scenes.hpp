// SPDX-License-Identifier: Apache-2.0
// What exporters are given to write.
#pragma once

#include "model/formats.hpp"
#include "scene/scene.hpp"

#include <vector>

namespace restage::check {

// Something of everything; names with spaces, quotes and letters of others; holes where things were removed.
scene::Scene everything_scene();
scene::Scene empty_scene(); // a camera and nothing else
scene::Scene geometry_scene(); // three objects of one mesh, at places of their own

// Every choice of every option, one at a time, after the defaults.
std::vector<scene::ParamSet> option_sets(const model::Exporter&);

} // namespace restage::check

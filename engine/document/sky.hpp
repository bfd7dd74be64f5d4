// SPDX-License-Identifier: Apache-2.0
// The edit that sets a plugin's sky, for callers that can wait. The editor generates the image on a thread
// (app/editor/sky_making.hpp).
#pragma once

#include "base/result.hpp"
#include "io/report.hpp"
#include "plugin/registry.hpp"
#include "scene/edit.hpp"

#include <glm/glm.hpp>
#include <string>

namespace restage::document {

// A sky of this type with these values; other parameters keep the current sky's values if it is of this type, else they
// take their defaults. Refused: a type without a plugin, values that its table does not accept. [any]
Result<scene::Edit> plugin_sky(const scene::Scene&, const plugin::Registry&, const std::string& type,
                               const scene::ParamSet& values, const glm::dvec3& up, const io::Progress& = {});

// For messages: "sunsky, dome", or a text saying that no sky plugin is loaded.
std::string known_skies(const plugin::Registry&);

} // namespace restage::document

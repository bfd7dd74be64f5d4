// SPDX-License-Identifier: Apache-2.0
// The edit that gives a scene the sky of a plugin, for callers that wait for it. The editor makes the picture on a
// thread (app/editor/sky_making.hpp).
#pragma once

#include "base/result.hpp"
#include "io/report.hpp"
#include "plugin/registry.hpp"
#include "scene/edit.hpp"

#include <glm/glm.hpp>
#include <string>

namespace restage::document {

// The sky of this type with these values; what is not among them is as the sky has it, where it is of this type
// already, else the default. Refused: a type that no plugin has, values that its table does not take. [any]
Result<scene::Edit> plugin_sky(const scene::Scene&, const plugin::Registry&, const std::string& type,
                               const scene::ParamSet& values, const glm::dvec3& up, const io::Progress& = {});

// "sunsky, dome", or that there is none: for messages.
std::string known_skies(const plugin::Registry&);

} // namespace restage::document

// SPDX-License-Identifier: Apache-2.0
// Exposure: light for scenes whose file says nothing of it. A picture of a scene without light is black, and one whose
// lamps are given in candela is white; a camera would measure, and so is done here, once, when such a file is opened.
#pragma once

#include "io/import.hpp"
#include "plugin/registry.hpp"
#include "query/light_meter.hpp"
#include "scene/edit.hpp"
#include "scene/scene.hpp"

namespace restage::document {

// Is there any: a lamp, a shining object that is not hidden, a sky that is not black?
bool has_light(const scene::Scene&, const plugin::Registry&);
inline constexpr const char* no_light = "nothing shines in this scene, so its picture is black";

query::LightReading read_light(const scene::Scene&, const plugin::Registry&); // of what the active camera sees

// Of a file that says nothing of exposure (ImportedScene::unexposed): the film's exposure is set so that white comes to
// 0.6 in the picture, where it would be below 0.08 or above 4; where no light reaches what the camera sees, studio
// light does (light_studio). Scenes of other files stay as they are. What was done, and that a scene has no light, is
// added to the report. [worker]
void expose(io::ImportedScene&, const plugin::Registry&);

// Studio light: a neutral sky, where there is none or a black one, and where that does not reach what the active camera
// sees (in a closed room) a lamp at the camera. [any]
scene::Edit light_studio(const scene::Scene&, const plugin::Registry&);

} // namespace restage::document

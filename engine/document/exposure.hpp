// SPDX-License-Identifier: Apache-2.0
// Exposure: for scenes whose file does not give it. A picture of a scene without light is black, and one whose
// lamps are in candela is white; like a camera, this meters the light, once, when such a file is opened.
#pragma once

#include "io/import.hpp"
#include "plugin/registry.hpp"
#include "query/light_meter.hpp"
#include "scene/edit.hpp"
#include "scene/scene.hpp"

namespace restage::document {

// Whether there is a lamp, a visible emissive object, or a sky that is not black.
bool has_light(const scene::Scene&, const plugin::Registry&);
inline constexpr const char* no_light = "nothing emits light in this scene, so its picture is black";

query::LightReading read_light(const scene::Scene&, const plugin::Registry&); // of what the active camera sees

// For a file without exposure (ImportedScene::unexposed): sets the film's exposure so that white becomes
// 0.6 in the picture, if it would be below 0.08 or above 4; if no light reaches what the camera sees, adds studio
// light (light_studio). Other scenes are unchanged. What was done, or that a scene has no light, is
// added to the report. [worker]
void expose(io::ImportedScene&, const plugin::Registry&);

// Studio light: a neutral sky, if there is none or a black one, and if that does not reach what the active camera
// sees (in a closed room) a lamp at the camera. [any]
scene::Edit light_studio(const scene::Scene&, const plugin::Registry&);

} // namespace restage::document

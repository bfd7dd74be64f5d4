// SPDX-License-Identifier: Apache-2.0
// Studio: the scene a new document begins with: a floor, a neutral sky, a camera that looks at where things will stand.
#pragma once

#include "scene/scene.hpp"

namespace restage::scene {

// y is up, lengths in metres.
Scene studio_scene();

} // namespace restage::scene

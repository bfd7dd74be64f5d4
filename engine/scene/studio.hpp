// SPDX-License-Identifier: Apache-2.0
// Studio: the initial scene of a new document: a floor, a neutral sky, a camera facing where objects will stand.
#pragma once

#include "scene/scene.hpp"

namespace restage::scene {

// y is up, lengths in metres.
Scene studio_scene();

} // namespace restage::scene

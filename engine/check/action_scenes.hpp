// SPDX-License-Identifier: Apache-2.0
// Scenes that actions are run over, with selections that give them something to do.
#pragma once

#include "check/configs.hpp"
#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace restage::check {

struct ActionScene {
    std::string name;
    scene::Scene scene;
    // In the order of picking, the last being the active one.
    std::vector<std::vector<scene::Id<scene::Instance>>> selections;
};

// With something of everything, and its objects in several numbers and orders; hills with a tree of two objects in a
// group, a stone, and the hills selected last, as a surface to work on; and a scene without objects.
std::vector<ActionScene> action_scenes(Engine&);

} // namespace restage::check

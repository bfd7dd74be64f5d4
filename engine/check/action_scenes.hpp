// SPDX-License-Identifier: Apache-2.0
// Test scenes for actions, with suitable selections.
#pragma once

#include "check/configs.hpp"
#include "scene/scene.hpp"

#include <string>
#include <vector>

namespace restage::check {

struct ActionScene {
    std::string name;
    scene::Scene scene;
    // In the order of selection; the last one is the active object.
    std::vector<std::vector<scene::Id<scene::Instance>>> selections;
};

// One with every kind of thing, and its objects in several numbers and orders; hills with a tree of two objects in a
// group, a stone, and the hills selected last, as the surface; and a scene without objects.
std::vector<ActionScene> action_scenes(Engine&);

} // namespace restage::check

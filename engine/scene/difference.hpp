// SPDX-License-Identifier: Apache-2.0
// difference: the edit that turns one state of a document into another one.
#pragma once

#include "scene/edit.hpp"

#include <string>

namespace restage::scene {

// Items are the same if they have the same id: both scenes are states of one document. What they share is not compared.
Edit difference(const Scene& before, const Scene& after, std::string label);

} // namespace restage::scene

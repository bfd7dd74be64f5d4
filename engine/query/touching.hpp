// SPDX-License-Identifier: Apache-2.0
// Touching: finds the parts of one thing that a file stores as separate objects (a chair as four legs, a seat and a
// cushion): objects that touch the selection, those that touch these, and so on, excluding much larger objects (the
// floor).
#pragma once

#include "scene/scene.hpp"

#include <functional>
#include <span>
#include <vector>

namespace restage::query {

// Visible objects that touch these, directly or through others. Two touch if their surfaces come closer than about
// a hundredth of the diagonal of the box around `ids`; objects with a box more than 2.5 times as large are
// excluded, as are those selected by `skip`.
std::vector<scene::Id<scene::Instance>> touching(const scene::Scene&, std::span<const scene::Id<scene::Instance>> ids,
                                                 const std::function<bool(scene::Id<scene::Instance>)>& skip = {});

} // namespace restage::query

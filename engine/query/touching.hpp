// SPDX-License-Identifier: Apache-2.0
// Touching: the parts of one thing, where a file has them as objects of their own (a chair as four legs, a seat and a
// cushion): what touches what is chosen, what touches that, and so on, up to things that are much larger (the floor).
#pragma once

#include "scene/scene.hpp"

#include <functional>
#include <span>
#include <vector>

namespace restage::query {

// Visible objects that touch these, directly or through others. Two touch where their surfaces come closer than about
// a hundredth of the diagonal of the box around `ids`; whose own box is more than 2.5 times as large is not one of
// them. Those that `skip` names are not looked at.
std::vector<scene::Id<scene::Instance>> touching(const scene::Scene&, std::span<const scene::Id<scene::Instance>> ids,
                                                 const std::function<bool(scene::Id<scene::Instance>)>& skip = {});

} // namespace restage::query

// SPDX-License-Identifier: Apache-2.0
// Edits of the tree of groups.
#pragma once

#include "base/result.hpp"
#include "scene/edit.hpp"

#include <span>

namespace restage::scene {

// Whether `inner` is the group `outer` or within it, at any depth.
bool is_in_group(const Scene&, Id<Group> inner, Id<Group> outer);

// Moves objects and groups into a group; into none: to the top level. Those that are in one of the groups themselves
// stay there: they come along. An error if a group would be within itself, or if everything is there already.
Result<Edit> reparent(const Scene&, std::span<const Id<Instance>>, std::span<const Id<Group>>, Id<Group> to);

} // namespace restage::scene

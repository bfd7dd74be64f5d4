// SPDX-License-Identifier: Apache-2.0
// Merging one scene into another, as an edit: everything its objects and lights need, under new ids. Its camera, film,
// settings and environment are not merged.
#pragma once

#include "scene/edit.hpp"

#include <set>
#include <string>
#include <vector>

namespace restage::scene {

struct Merged {
    Edit edit;
    std::vector<Id<Instance>> instances; // the new ones, in their order in `from`
    Id<Group> group; // their group; none for a single object
};

// Objects keep their places, except for the frame: `from` is rotated to share the up axis of `into`, and mirrored if
// their handedness differs; both are taken from the active cameras. Names already in use get a number.
// Several objects are put into one group called `name`.
Merged merge(const Scene& into, const Scene& from, const std::string& name);

// Only the change of frame.
glm::dmat4 frame_change(const Scene& into, const Scene& from);

// "chair" -> itself, or "chair 2", "chair 3", ... skipping names in use; marks the result used.
std::string free_name(const std::string& name, std::set<std::string>& taken);

} // namespace restage::scene

// SPDX-License-Identifier: Apache-2.0
// One scene put into another, as an edit: everything that its objects and lights need, under new ids. Its camera, film,
// settings and environment stay behind.
#pragma once

#include "scene/edit.hpp"

#include <set>
#include <string>
#include <vector>

namespace restage::scene {

struct Merged {
    Edit edit;
    std::vector<Id<Instance>> instances; // the new ones, in their order in `from`
    Id<Group> group; // what they lie in; none when it is a single object
};

// Objects keep their places, but for the frame: `from` is turned so that its up is that of `into`, and mirrored when
// one is right-handed and the other not; both are read off the active cameras. Names that are taken get a number.
// Several objects come as one group called `name`.
Merged merge(const Scene& into, const Scene& from, const std::string& name);

// The change of frame alone.
glm::dmat4 frame_change(const Scene& into, const Scene& from);

// "chair" -> itself, or "chair 2", "chair 3", ... past every name that is taken; takes it.
std::string free_name(const std::string& name, std::set<std::string>& taken);

} // namespace restage::scene

// SPDX-License-Identifier: Apache-2.0
// Where a copy goes, so that it is seen: beside its original, and inside the picture.
#pragma once

#include "scene/bounds.hpp"
#include "scene/scene.hpp"

namespace restage::query {

// An offset along one of the two axes of the world perpendicular to `up` (an axis of the world), by a little more than
// the box's size along it, at least `least`: the first of right, left, towards the viewer and away from it for which
// the moved box is inside the picture; if none is, the one with the largest part inside.
glm::dvec3 visible_offset(const scene::Camera&, double aspect, const glm::dvec3& up, const scene::Bounds& box,
                          double least);

// The part of the rectangle around the box's projection that is inside the picture, 0 to 1; 0 if a corner is behind the
// camera.
double visible_part(const scene::Camera&, double aspect, const scene::Bounds& box);

} // namespace restage::query

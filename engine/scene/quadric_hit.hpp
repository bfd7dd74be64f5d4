// SPDX-License-Identifier: Apache-2.0
// Intersection of an object-space ray with a quadric, in double precision: for the CPU tracer and picking.
#pragma once

#include "scene/quadric.hpp"

namespace restage::scene {

// Distances in units of d, ascending, including negative ones. Returns their number: 0 to 2.
int meet(const Quadric&, glm::dvec3 o, glm::dvec3 d, double (&t)[2]);

} // namespace restage::scene

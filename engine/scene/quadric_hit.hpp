// SPDX-License-Identifier: Apache-2.0
// Where a ray in object space meets a quadric, in double precision: for the CPU's tracer and for picking.
#pragma once

#include "scene/quadric.hpp"

namespace restage::scene {

// Distances in units of d, ascending, negative ones too. Returns how many: 0 to 2.
int meet(const Quadric&, glm::dvec3 o, glm::dvec3 d, double (&t)[2]);

} // namespace restage::scene

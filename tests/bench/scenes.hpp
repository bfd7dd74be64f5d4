// SPDX-License-Identifier: Apache-2.0
// The scenes the bench makes for itself, y up. `edges`: path edges counted as in the peers' tables; a path of n edges
// has n - 1 bounces, pbrt's maxdepth.
#pragma once

#include "scene/scene.hpp"

#include <vector>

namespace restage::bench {

// A closed room of 10 x 4 x 8 with two area lights and 20 instances of one displaced sphere of 199,692 triangles:
// diffuse, GGX conductor (alpha 0.2) and smooth glass. 512x512.
scene::Scene room(std::uint32_t bounces);

// Cornell box, diffuse only, 8 instances, 32 triangles. 512x512, 5 bounces.
scene::Scene cornell();

// `count` instances of one sphere of `cells`^2 * 12 triangles over a floor, four materials. `spheres` gets the ids.
scene::Scene crowd(std::uint32_t count, std::uint32_t cells, std::vector<scene::Id<scene::Instance>>& spheres);

} // namespace restage::bench

// SPDX-License-Identifier: Apache-2.0
// Support: the distance objects fall until they rest on something: for editing, not for physics, nothing tips over.
// Exact between triangles (query/collision.hpp); to a raster's cells where one of the two is a quadric.
#pragma once

#include "scene/scene.hpp"

#include <optional>
#include <span>

namespace restage::query {

// How far these, as one body, can move against `up` (unit) until some part rests on something visible; less
// than 0 if it is sunk into its support, by up to a tenth of its size. nullopt if there is nothing below.
std::optional<double> fall_distance(const scene::Scene&, std::span<const scene::Id<scene::Instance>>,
                                    const glm::dvec3& up);

} // namespace restage::query

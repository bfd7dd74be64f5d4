// SPDX-License-Identifier: Apache-2.0
// Support: how far things fall until they stand on something. From the triangles of the scene, for editing, not for
// physics: nothing tips over.
#pragma once

#include "scene/scene.hpp"

#include <optional>
#include <span>

namespace restage::query {

// How far these, as one body, can go against `up` (unit) until some part of it lies on something that is visible; less
// than 0 where it is sunk into what it stands on, by up to a tenth of its height. None: there is nothing below.
std::optional<double> fall_distance(const scene::Scene&, std::span<const scene::Id<scene::Instance>>,
                                    const glm::dvec3& up);

} // namespace restage::query

// SPDX-License-Identifier: Apache-2.0
// A floor that is a shadow catcher, below what is visible.
#pragma once

#include "base/result.hpp"
#include "scene/edit.hpp"

#include <glm/glm.hpp>
#include <string>

namespace restage::scene {

struct ShadowFloor {
    Edit edit;
    Id<Instance> floor;
};
// A square across `up` (unit), just below the lowest point of the boxes of visible objects, other catchers aside; its
// sides are 40 times the radius of these. `material`: the type of its material, which only exported files use. An error
// if nothing is visible.
Result<ShadowFloor> add_shadow_floor(const Scene&, const glm::dvec3& up, const std::string& material);

} // namespace restage::scene

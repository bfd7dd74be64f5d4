// SPDX-License-Identifier: Apache-2.0
// Builders of edits of lights without a surface, as edits.hpp has them of other things.
#pragma once

#include "scene/edits.hpp"

namespace restage::scene {

struct DuplicateLight {
    Edit edit;
    Id<Light> copy;
};
Result<DuplicateLight> duplicate_light(const Scene&, Id<Light>, const glm::dmat4& move); // world space

} // namespace restage::scene

// SPDX-License-Identifier: Apache-2.0
// Edit builders for lights without a surface, like edits.hpp for other things.
#pragma once

#include "scene/edits.hpp"

namespace restage::scene {

struct DuplicateLight {
    Edit edit;
    Id<Light> copy;
};
Result<DuplicateLight> duplicate_light(const Scene&, Id<Light>, const glm::dmat4& move); // world space

} // namespace restage::scene

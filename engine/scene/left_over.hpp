// SPDX-License-Identifier: Apache-2.0
// What a change of a scene left without a user.
#pragma once

#include "scene/edit.hpp"

namespace restage::scene {

// Removes the meshes, materials, textures, images and media that are used in `before` and not in `after`.
Edit remove_left_over(const Scene& before, const Scene& after);

} // namespace restage::scene

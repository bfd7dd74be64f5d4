// SPDX-License-Identifier: Apache-2.0
// How much a scene holds.
#pragma once

#include "scene/scene.hpp"

#include <cstddef>

namespace restage::scene {

struct Statistics {
    std::size_t objects = 0, hidden = 0; // hidden ones are counted in both
    std::size_t triangles = 0; // of all meshes, shared data once
    std::size_t instanced = 0; // of all objects: a mesh counts as often as it is used
    std::size_t geometry_bytes = 0, pixel_bytes = 0; // in host memory; shared ones once
};
Statistics statistics_of(const Scene&);

} // namespace restage::scene

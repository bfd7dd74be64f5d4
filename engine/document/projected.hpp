// SPDX-License-Identifier: Apache-2.0
// Texture coordinates for objects that are given a textured material and have none.
#pragma once

#include "plugin/registry.hpp"
#include "scene/edit.hpp"

#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace restage::document {

struct Projected {
    scene::Edit edit;
    std::vector<scene::Id<scene::Instance>> objects; // that got coordinates
};
// The edit, followed by box projection (scene/box_projection.hpp) for those of the objects whose mesh has no texture
// coordinates, though a texture of their material, as it is after the edit, needs some. One repetition of a texture
// covers the largest of them. [any]
Projected project_where_needed(const scene::Scene& before, scene::Edit edit,
                               std::span<const scene::Id<scene::Instance>> objects, const plugin::Registry& registry,
                               const glm::dvec3& up);

} // namespace restage::document

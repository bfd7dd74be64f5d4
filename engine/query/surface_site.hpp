// SPDX-License-Identifier: Apache-2.0
// Places on the surface of an object with their texture coordinates, for placing textures by eye.
#pragma once

#include "scene/scene.hpp"

#include <optional>

namespace restage::query {

struct SurfacePlace { // valid while the object has the same mesh, wherever it is moved
    scene::Id<scene::Instance> instance;
    std::uint32_t triangle = 0;
    glm::dvec2 at{0}; // weights of its second and third corner; of a quadric: uv
    bool operator==(const SurfacePlace&) const = default;
};

// Where the ray first meets this object, whatever is before it; none if it misses.
std::optional<SurfacePlace> place_on(const scene::Scene&, scene::Id<scene::Instance>, const glm::dvec3& origin,
                                     const glm::dvec3& direction);

struct SurfaceSite { // in world space
    glm::dvec3 position{0}, normal{0}; // geometric, unit: cross(dpdu, dpdv)
    glm::dvec2 uv{0};
    glm::dvec3 dpdu{0}, dpdv{0}; // of the position, by uv
};

// `set`: 1 = the mesh's second uv, if it has them. None if the place no longer exists, or texture coordinates do not
// vary there (a mesh without them has none).
std::optional<SurfaceSite> site_at(const scene::Scene&, const SurfacePlace&, int set);

} // namespace restage::query

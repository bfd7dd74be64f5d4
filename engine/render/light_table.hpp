// SPDX-License-Identifier: Apache-2.0
// The scene's lights as one table, chosen by power: a triangle of an emissive instance, a point, a spot, a distant
// light or the environment each is one entry. World space is relative to the render origin.
#pragma once

#include "scene/scene.hpp"
#include "shared/scene_data.h"

#include <functional>
#include <optional>
#include <vector>

namespace restage::render {

struct LightTable {
    std::vector<shared::LightData> lights;
    std::vector<shared::AliasEntry> alias; // empty: nothing emits
    std::vector<std::uint32_t> light_base; // by Id<Instance>::value; NONE for what does not emit
    std::uint32_t environment = NONE;      // its index in `lights`
};

// A surface that shines.
struct Emitter {
    glm::vec3 radiance{0}; // [W/(m^2 sr)]
    bool two_sided = false;
    bool varies = false; // by a texture of emission or by alpha: looked up at the point that is sampled
    // The mean luminance over a triangle, of what is not the same everywhere; approximate: it only chooses among
    // lights. null: that of `radiance`
    std::function<double(std::uint32_t triangle)> mean;
};

// environment_mean: mean radiance of the environment over the sphere, scale applied (0 = none).
// radius: of the scene's bounds, for what shines from infinitely far.
// emitter: asked of each instance once; nullopt = it is no entry. So are mixes with a share of nothing: paths find them
// by BSDF sampling alone.
LightTable make_light_table(const scene::Scene&, const glm::dvec3& origin, const glm::vec3& environment_mean,
                            double radius,
                            const std::function<std::optional<Emitter>(scene::Id<scene::Instance>)>& emitter);

// Which side of a triangle is out: its normal in world space, by the rule of shaders/path/surface.glsl.
glm::dvec3 outward_normal(const scene::Instance&, const scene::MeshData&, const glm::uvec3& triangle);

} // namespace restage::render

// SPDX-License-Identifier: Apache-2.0
// The scene's lights as one table: a triangle of an emissive instance, a quadric, a point, a spot, a distant light or
// the environment is one entry each; and the emitters that they belong to, in a tree. World space is relative to the
// render origin.
#pragma once

#include "scene/scene.hpp"
#include "shared/scene_data.h"

#include <functional>
#include <optional>
#include <vector>

namespace restage::render {

struct LightTable {
    std::vector<shared::LightData> lights; // those of an emitter are neighbours
    std::vector<shared::CdfEntry> cdf;     // parallel to `lights`, a table for each emitter
    std::vector<shared::LightNode> nodes;  // LightTree; empty: nothing emits
    std::uint32_t roots = 0;
    std::uint32_t kinds = 0;               // LIGHTS_*
    std::vector<std::uint32_t> light_base; // by Id<Instance>::value; NONE if not emissive
    std::uint32_t environment = NONE;      // its index in `lights`
};

// An emissive surface.
struct Emitter {
    glm::vec3 radiance{0}; // [W/(m^2 sr)]
    std::optional<glm::vec3> stored = {}; // what LightData.value is set to; none: the radiance
    bool two_sided = false;
    bool varies = false; // by an emission texture or by alpha: looked up at the sampled point
    // The mean luminance over a triangle if it varies; approximate: it only chooses among
    // lights. null: that of `radiance`
    std::function<double(std::uint32_t triangle)> mean;
};

// environment_mean: mean radiance of the environment over the sphere, scale applied (0 = none).
// emitter: called once per instance; nullopt = no entry, as for mixes with a null component: paths find them
// by BSDF sampling only.
// lamp: what LightData.value of a light without a surface is set to; null: its value.
LightTable make_light_table(const scene::Scene&, const glm::dvec3& origin, const glm::vec3& environment_mean,
                            const std::function<std::optional<Emitter>(scene::Id<scene::Instance>)>& emitter,
                            const std::function<glm::vec3(const scene::Light&)>& lamp = {});

// Replaces the lights of one emitter that is in the table and has moved or changed its emission, and refits the tree:
// its bounds hold, though it may choose less well than a new one. nullopt: their number or kind differs; nothing is
// changed.
struct Replaced {
    std::uint32_t first = 0, count = 0; // of lights
    std::vector<std::uint32_t> nodes;
};
std::optional<Replaced> replace_emitter(LightTable&, const scene::Scene&, const glm::dvec3& origin,
                                        scene::Id<scene::Instance>, const std::optional<Emitter>&);

// The outside of a triangle: its normal in world space, by the rule of shaders/path/surface.glsl.
glm::dvec3 outward_normal(const scene::Instance&, const scene::MeshData&, const glm::uvec3& triangle);

} // namespace restage::render

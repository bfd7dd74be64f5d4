// SPDX-License-Identifier: Apache-2.0
// Edit builders for lights without a surface, like edits.hpp for other things.
#pragma once

#include "model/material.hpp"
#include "scene/edits.hpp"

namespace restage::scene {

struct DuplicateLight {
    Edit edit;
    Id<Light> copy;
};
Result<DuplicateLight> duplicate_light(const Scene&, Id<Light>, const glm::dmat4& move); // world space

// The light goes around `at`, keeping its distance, to where it is seen from there in `direction` (unit). One that is
// aimed shines towards `at` then. An error if it is at `at`.
Result<Edit> light_from(const Scene&, Id<Light>, const glm::dvec3& at, const glm::dvec3& direction);
// Likewise the centre of these objects together, which turn with it.
Result<Edit> light_from(const Scene&, std::span<const Id<Instance>>, const glm::dvec3& at, const glm::dvec3& direction);

// Multiplies what a material emits by `factor` (linear RGB); `type` is its plugin's table, with `emission`. An error if
// the table has no value for that: a texture's colour stays.
Result<Edit> scale_emission(const Scene&, Id<Material>, const model::Material& type, const glm::vec3& factor);

} // namespace restage::scene

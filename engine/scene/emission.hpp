// SPDX-License-Identifier: Apache-2.0
// What a material emits by itself (restage.emission/1). Lights are made of it by render/, and written by io/.
#pragma once

#include "model/material.hpp"
#include "scene/params.hpp"

#include <glm/vec3.hpp>
#include <optional>

namespace restage::scene {

struct MaterialEmission {
    glm::vec3 radiance{0}; // [W/(m^2 sr)]; times the texture, where there is one
    Id<Texture> texture;
    bool two_sided = false;
    bool operator==(const MaterialEmission&) const = default;
};

// nullopt = it is dark, or its values are no light: negative or non-finite.
std::optional<MaterialEmission> emission_of(const model::Material&, const ParamSet&);

} // namespace restage::scene

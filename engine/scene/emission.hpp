// SPDX-License-Identifier: Apache-2.0
// A material's own emission (restage.emission/1). render/ turns it into lights; io/ writes it.
#pragma once

#include "model/material.hpp"
#include "scene/params.hpp"

#include <glm/vec3.hpp>
#include <optional>

namespace restage::scene {

struct MaterialEmission {
    glm::vec3 radiance{0}; // [W/(m^2 sr)]; times the texture, if any
    Id<Texture> texture;
    bool two_sided = false;
    bool operator==(const MaterialEmission&) const = default;
};

// nullopt = no emission, or its values are invalid: negative or non-finite.
std::optional<MaterialEmission> emission_of(const model::Material&, const ParamSet&);

} // namespace restage::scene

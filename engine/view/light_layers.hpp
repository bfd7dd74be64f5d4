// SPDX-License-Identifier: Apache-2.0
// Light layers: a scene's lights in the groups in which they are mixed, and what a mix means for the scene.
#pragma once

#include "base/result.hpp"
#include "scene/edit.hpp"
#include "view/light_board.hpp"

#include <span>
#include <string>
#include <vector>

namespace restage::view {

struct LightLayer {
    std::string name; // "lamp", "lamp and 3 more"
    std::string kind; // for people: "Sky", "Spot", "Lamps"
    std::vector<LightKey> lights; // in the scene's order; never empty
    bool tinted = true; // its colour can change: false if that is a texture
};

// The sky; each light that is on; the emitting objects, those of equal material and emission together, by their power
// (luminance times area), the strongest first. What is hidden or dark has no layer. Of more than `most` layers the last
// are one.
std::vector<LightLayer> light_layers(const scene::Scene&, const plugin::Registry&, std::size_t most);

// Multiplies the light of each layer by its weight (linear RGB, at least 0): one edit. What emits by its material keeps
// that, and the material's values change. An error if a layer that is not `tinted` has a coloured weight, or a light
// does not exist any more.
Result<scene::Edit> weigh_lights(const scene::Scene&, const plugin::Registry&, std::span<const LightLayer>,
                                 std::span<const glm::vec3> weights);

} // namespace restage::view

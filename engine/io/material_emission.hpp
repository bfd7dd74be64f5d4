// SPDX-License-Identifier: Apache-2.0
// What a material of a scene emits, asked of the plugin that provides it.
#pragma once

#include "plugin/registry.hpp"
#include "scene/emission.hpp"
#include "scene/scene.hpp"

namespace restage::io {

// Cheap to make: once for a walk over many instances.
class MaterialEmissions {
  public:
    MaterialEmissions(const plugin::Registry&, const scene::Scene&); // the scene outlives it
    // nullopt = it is dark, or its plugin is missing.
    std::optional<scene::MaterialEmission> of(scene::Id<scene::Material>) const;
    bool shines(const scene::Instance& i) const { return i.emission || of(i.material); }

  private:
    const scene::Scene& scene_;
    std::vector<plugin::MaterialEntry> types_; // those that may shine
};

// The mean of a texture's colours over the unit square, for formats whose lights have one colour: what the engine does
// not evaluate has its `average`. White where there is no texture.
glm::vec3 mean_of(const scene::Scene&, scene::Id<scene::Texture>);

} // namespace restage::io

// SPDX-License-Identifier: Apache-2.0
// Emission of a scene's materials, as declared by their plugins.
#pragma once

#include "plugin/registry.hpp"
#include "scene/emission.hpp"
#include "scene/scene.hpp"

namespace restage::io {

// Cheap to create: one per walk over many instances.
class MaterialEmissions {
  public:
    MaterialEmissions(const plugin::Registry&, const scene::Scene&); // the scene must outlive it
    // nullopt = no emission, or its plugin is missing.
    std::optional<scene::MaterialEmission> of(scene::Id<scene::Material>) const;
    bool shines(const scene::Instance& i) const { return i.emission || of(i.material); }

  private:
    const scene::Scene& scene_;
    std::vector<plugin::MaterialEntry> types_; // those that may emit
};

// The mean of a texture's colours over the unit square, for formats whose lights have one colour: one the engine does
// not evaluate counts as its `average`. White if there is no texture.
glm::vec3 mean_of(const scene::Scene&, scene::Id<scene::Texture>);

} // namespace restage::io

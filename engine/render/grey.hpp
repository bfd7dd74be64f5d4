// SPDX-License-Identifier: Apache-2.0
// Whether a scene has only greys, so that spectral mode would only cost time.
#pragma once

#include "render/material_types.hpp"
#include "scene/scene.hpp"

#include <map>
#include <memory>

namespace restage::render {

// Conservative: false if in doubt. A scene is grey if
//   - every colour of its materials, textures, lamps, environment and media has three equal components, set or by
//     default, whether it is visible or not;
//   - so has every texel of images that textures or the environment use;
//   - nothing has a measured spectrum (SpectralCurves), and no material has a table or is read from one;
//   - no GLSL of its materials' or textures' plugins asks for wavelengths, converts RGB, or uses a thin film. Textures
//   of
//     an image may convert its colour.
class GreyTest {
  public:
    bool passes(const scene::Scene&, const MaterialLookup&);

  private:
    bool grey_image(const scene::Scene&, scene::Id<scene::Image>);
    std::map<std::shared_ptr<const scene::PixelData>, bool> images_; // tested, and still in the scene
};

} // namespace restage::render

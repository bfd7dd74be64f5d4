// SPDX-License-Identifier: Apache-2.0
// Sky: edits of the environment. [any]
#pragma once

#include "scene/edit.hpp"

#include <glm/glm.hpp>
#include <memory>
#include <string>

namespace restage::scene {

// The rotation of an environment whose pole, +z in a panorama, points along `up` (a unit vector).
glm::dmat4 upright_sky(const glm::dvec3& up);

// A neutral environment: a wide soft box overhead and one at the side, generated without a file.
Edit studio_sky(const Scene& scene, const glm::dvec3& up);

// The image, with its pixels read as scene::Encoding::srgb, becomes the sky; square images are octahedral maps as in
// pbrt-v4, others panoramas. If the sky was an image of the same mapping, its rotation and strength stay. An image
// already in the scene is reused.
Edit image_sky(const Scene& scene, const std::string& path, std::shared_ptr<const PixelData> pixels,
               const glm::dvec3& up);

// Sets a sky plugin's image, with its values and this name, as the sky. If the sky is already a plugin's, its image is
// replaced, and rotation, strength and visibility are kept. `pixels`: square, octahedral, +z up.
Edit made_sky(const Scene& scene, const std::string& name, const std::string& type, ParamSet values,
              std::shared_ptr<const PixelData> pixels, const glm::dvec3& up);

} // namespace restage::scene

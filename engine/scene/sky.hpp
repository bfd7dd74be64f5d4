// SPDX-License-Identifier: Apache-2.0
// Sky: edits that light a scene from all around. [any]
#pragma once

#include "scene/edit.hpp"

#include <glm/glm.hpp>
#include <memory>
#include <string>

namespace restage::scene {

// The rotation of an environment whose pole, +z in a panorama, points along `up` (a unit vector).
glm::dmat4 upright_sky(const glm::dvec3& up);

// Soft grey light from all around: a wide soft box overhead and one at the side, made without a file.
Edit studio_sky(const Scene& scene, const glm::dvec3& up);

// The image, with its pixels read as scene::Encoding::srgb, becomes the sky; square ones are octahedral maps as pbrt-v4
// has them, others panoramas. The rotation and strength of a sky that was an image of the same mapping stay. An image
// the scene has already is used again.
Edit image_sky(const Scene& scene, const std::string& path, std::shared_ptr<const PixelData> pixels,
               const glm::dvec3& up);

// A sky plugin's picture with its values becomes the sky, under this name. Rotation, strength and whether it is seen
// stay where the sky was a plugin's already; its picture is replaced. `pixels`: square, octahedral, +z up.
Edit made_sky(const Scene& scene, const std::string& name, const std::string& type, ParamSet values,
              std::shared_ptr<const PixelData> pixels, const glm::dvec3& up);

} // namespace restage::scene

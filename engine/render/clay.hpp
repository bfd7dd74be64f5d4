// SPDX-License-Identifier: Apache-2.0
// A picture of first hits alone: what stands where, as if of clay and lit from the camera. It needs Embree and no
// shader, so it is there before anything is compiled; with the guides that picking and outlines go by.
#pragma once

#include "base/jobs.hpp"
#include "render/embree_scene.hpp"
#include "render/film.hpp"

namespace restage::render {

// Of the whole film as the scene's camera sees it, `size` pixels large. Colours are in [0,1], whatever the exposure.
FilmImage clay_picture(const GpuScene& scene, const EmbreeScene& embree, Jobs& jobs, glm::uvec2 size);

} // namespace restage::render

// SPDX-License-Identifier: Apache-2.0
// A picture of first hits only: the geometry as clay, lit from the camera, or drawn to show its triangles or its
// texture coordinates. It needs Embree but no shaders, so it is available before anything is compiled; includes the
// guides for picking and outlines.
#pragma once

#include "base/jobs.hpp"
#include "render/clay_look.hpp"
#include "render/embree_scene.hpp"
#include "render/film.hpp"

namespace restage::render {

// Covers the whole film of the scene's camera, `size` pixels large. Colours are in [0,1], whatever the exposure.
FilmImage clay_picture(const GpuScene& scene, const EmbreeScene& embree, Jobs& jobs, glm::uvec2 size,
                       ClayLook look = ClayLook::clay);

} // namespace restage::render

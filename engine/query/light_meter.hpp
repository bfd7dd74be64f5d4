// SPDX-License-Identifier: Apache-2.0
// Light meter: the light that falls on what a camera sees, estimated on the CPU without materials or shaders; for
// choosing an exposure, not for pictures.
#pragma once

#include "scene/emission.hpp"
#include "scene/scene.hpp"

#include <functional>
#include <optional>

namespace restage::query {

struct LightReading {
    double white = 0; // radiance of a white matte surface there: the log average over lit points [W/(m^2 sr)]
    double lit = 0;   // fraction of the points reached by any light
    bool something = false; // the camera sees any surface
};

struct MeterQuestions { // of an instance
    std::function<bool(const scene::Instance&)> passes; // light passes through it: skipped
    std::function<std::optional<scene::MaterialEmission>(const scene::Instance&)> emission; // without textures
    std::function<double(const scene::Instance&)> albedo; // 0 to 1
    glm::vec3 sky{0}; // mean radiance from all directions
};

// From the active camera, through a pinhole. Direct light of lamps and emitters, and its reflection by surrounding
// matte surfaces: one bounce by rays, more extrapolated. Directions are fixed: identical for the same scene except for
// the last bits.
LightReading read_light(const scene::Scene&, const MeterQuestions&);

} // namespace restage::query

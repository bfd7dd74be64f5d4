// SPDX-License-Identifier: Apache-2.0
// Light meter: how much light falls on what a camera sees, estimated on the CPU without materials or shaders; for
// choosing an exposure, not for pictures.
#pragma once

#include "scene/emission.hpp"
#include "scene/scene.hpp"

#include <functional>
#include <optional>

namespace restage::query {

struct LightReading {
    double white = 0; // radiance of a white matte surface there: the log average over lit points [W/(m^2 sr)]
    double lit = 0;   // part of the points that any light reaches
    bool something = false; // the camera sees a surface at all
};

struct MeterQuestions { // of an instance
    std::function<bool(const scene::Instance&)> passes; // light goes through it: left out
    std::function<std::optional<scene::MaterialEmission>(const scene::Instance&)> emission; // without textures
    std::function<double(const scene::Instance&)> albedo; // 0 to 1
    glm::vec3 sky{0}; // mean radiance from all around
};

// From the active camera, through a pinhole. Direct light of lamps and shining surfaces, and what matte surfaces around
// reflect of lamps: once by rays, more often as if it went on alike. Directions are fixed: the same for the same scene
// but for the last bits.
LightReading read_light(const scene::Scene&, const MeterQuestions&);

} // namespace restage::query

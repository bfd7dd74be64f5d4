// SPDX-License-Identifier: Apache-2.0
// Camera moves for series of pictures: one turn around the scene, and a path through given cameras. Pure functions.
#pragma once

#include "scene/scene.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace restage::query {

// The camera turned to the right around the visible objects [deg]: about the world axis nearest to its up, through the
// point of its line of sight that is nearest to their centre. Unchanged if nothing is visible.
scene::Camera turned(const scene::Scene&, const scene::Camera&, double degrees);

// Cameras on the way through the given ones (at least one), the first and the last of them included, if `frames` > 1.
// Each stretch between two takes equally long. Positions are on a Catmull-Rom spline (Catmull and Rom 1974), rotations
// turn the shorter way at constant speed (slerp), field of view and lens change linearly; all else is the first's.
std::vector<scene::Camera> camera_path(std::span<const scene::Camera> through, std::uint32_t frames);

// All cameras of the scene, in its order: those that a path goes through.
std::vector<scene::Camera> all_cameras(const scene::Scene&);
// The scene seen from this camera instead of the active one, which keeps its name.
scene::Scene seen_from(scene::Scene, const scene::Camera&);

} // namespace restage::query

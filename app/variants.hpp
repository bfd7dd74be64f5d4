// SPDX-License-Identifier: Apache-2.0
// Several pictures of one scene: --look and --camera, each a name or "all", --turntable, and {look}, {camera} and # in
// names of files.
#pragma once

#include "document/looks.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace restage::app {

struct Variant {
    std::string look;   // "" = the scene as it is
    std::string camera; // "" = the active one
    std::uint32_t frame = 0; // of a turntable, from 1; 0 = no turntable
    double turn = 0; // of the camera, see turn_camera [deg]
};

// In the order of the document, all cameras of a look together, and all frames of these: one turn in `frames` steps;
// 0 = one picture. Errors name an unknown look and those there are.
Result<std::vector<Variant>> variants(const scene::Scene& scene, const document::Looks& looks, const std::string& look,
                                      const std::string& camera, std::uint32_t frames);

// Turns the active camera to the right around the visible objects [deg]: about the scene's up axis, through the point
// of its line of sight that is nearest to their centre.
void turn_camera(scene::Scene& scene, double degrees);

// "{look}-{camera}.##.png" -> "Oak-Camera 1.07.png". Characters that a file's name cannot have become "_".
std::string variant_path(std::string pattern, const Variant& variant);
// Of several variants: fails if two of them have the same path.
Result<> check_variant_paths(const std::string& pattern, const std::vector<Variant>& variants);

} // namespace restage::app

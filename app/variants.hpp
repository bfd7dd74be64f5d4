// SPDX-License-Identifier: Apache-2.0
// Several pictures of one scene: --look and --camera, each a name or "all", --turntable, --camera-path, and {look},
// {camera} and # in names of files.
#pragma once

#include "document/looks.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace restage::app {

struct Variant {
    std::string look;   // "" = the scene as it is
    std::string camera; // "" = the active one
    std::uint32_t frame = 0; // of the move, from 1; 0 = the camera stands
};

// How the camera moves from frame to frame; without frames it stands.
struct CameraMove {
    std::uint32_t turntable = 0, path = 0; // frames of one turn, or of the way through all cameras; one of them is 0
    std::uint32_t frames() const { return turntable + path; }
    // "turned by 90 degrees", "frame 3 of 24 on the path through all cameras"; "" = it stands
    std::string what(std::uint32_t frame) const;
};

// In the order of the document, all cameras of a look together, and all frames of these; no frames = one picture.
// Errors name an unknown look and those there are.
Result<std::vector<Variant>> variants(const scene::Scene& scene, const document::Looks& looks, const std::string& look,
                                      const std::string& camera, const CameraMove& move);

// Moves the active camera to where it is in that frame. Error: a path through fewer than two cameras.
Result<> move_camera(scene::Scene& scene, const CameraMove& move, std::uint32_t frame);

// "{look}-{camera}.##.png" -> "Oak-Camera 1.07.png". Characters that a file's name cannot have become "_".
std::string variant_path(std::string pattern, const Variant& variant);
// Of several variants: fails if two of them have the same path. All frames of a video may.
Result<> check_variant_paths(const std::string& pattern, const std::vector<Variant>& variants);

} // namespace restage::app

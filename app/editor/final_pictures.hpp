// SPDX-License-Identifier: Apache-2.0
// Final pictures: what the user wishes for, and the shots of the document that follow from it, rendered one after the
// other in the background while editing continues. Their scenes are those of the moment they were asked for.
#pragma once

#include "scene/scene.hpp"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace restage::editor {

class PanelContext;

enum class CameraMove { none, turntable, path };

struct FinalWish {
    std::uint32_t samples = 64;
    float error = 0; // > 0: stop at this error, or at `samples`
    bool from_view = true; // instead of the scene's camera, if they differ
    bool denoise = true;
    bool all_looks = false, all_cameras = false; // each is a shot, and its name a part of the file's
    CameraMove move = CameraMove::none; // each shot is a series of pictures, or a video
    std::uint32_t frames = 48; // of a move
    float fps = 24; // of a video
    std::string denoiser; // as in Preferences
    std::filesystem::path path;
};

struct Shot {
    scene::Scene scene;
    std::string name; // "Oak, Camera 2"; "" = there is only this one
    std::filesystem::path path; // of the picture or video; of a series: without the numbers
    std::vector<scene::Camera> cameras; // of a move, one for each frame
};

// One shot for each look and camera that is wished for. A path through all cameras is one shot.
std::vector<Shot> shots_of(const PanelContext& editor, const FinalWish& wish);
// "turn.png" -> "turn 0007.png"
std::filesystem::path frame_file(const std::filesystem::path& path, std::size_t frame);

// Renders them; what cannot be done is a notice.
void start_final_pictures(PanelContext& editor, const FinalWish& wish);

} // namespace restage::editor

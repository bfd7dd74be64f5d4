// SPDX-License-Identifier: Apache-2.0
// Pictures as files: what a film holds, with the denoised picture beside it, as .exr with layers or as a plain image.
#pragma once

#include "base/result.hpp"
#include "render/film_layers.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace restage::view {

struct Picture {
    render::FilmImage film;
    std::optional<std::vector<glm::vec3>> denoised;
    float exposure = 1; // of the scene's film
    std::string denoiser = "none"; // who made `denoised`: "oidn high"
};

struct PictureOptions {
    std::string aovs = "all"; // comma-separated aov_names(), or all, or none
    float exposure_stops = 0; // PNG and JPEG only
    std::map<std::string, std::string> metadata;
};
// The layers that an .exr can have beside the picture: stderr, albedo, ...
std::vector<std::string> aov_names();
// Names of layers that there are, commas between, or all, or none; an error lists them.
Result<void> check_aovs(const std::string& aovs);
// Before hours are spent: can a picture be written there at all?
Result<void> check_picture_path(const std::string& path);
// .exr: the picture, the layers that are wanted and metadata. .png, .jpg: exposure and sRGB. .pfm, .hdr: the picture.
// The same picture and options give the same bytes.
Result<void> write_picture(const std::string& path, const Picture& picture, const PictureOptions& options);

} // namespace restage::view

// SPDX-License-Identifier: Apache-2.0
// Pictures as files: what a film holds, with the denoised picture beside it, as .exr with layers or as a plain image.
#pragma once

#include "base/result.hpp"
#include "render/film.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace restage::session {

struct Picture {
    render::FilmImage film;
    std::optional<std::vector<glm::vec3>> denoised;
    float exposure = 1; // of the scene's film
};

struct PictureOptions {
    std::string aovs = "all"; // comma-separated: stderr albedo normal depth id | all | none
    float exposure_stops = 0; // PNG only
    std::map<std::string, std::string> metadata;
};
// Before hours are spent: can a picture be written there at all?
Result<void> check_picture_path(const std::string& path);
// .exr: the picture, the layers that are wanted and metadata. .png: exposure and sRGB. .pfm, .hdr: the picture.
Result<void> write_picture(const std::string& path, const Picture& picture, const PictureOptions& options);

} // namespace restage::session

// SPDX-License-Identifier: Apache-2.0
// Pictures as files: a film's contents, with the denoised picture, as layered .exr or as a plain image.
#pragma once

#include "base/result.hpp"
#include "render/film_layers.hpp"
#include "scene/scene.hpp"

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace restage::view {

struct Picture {
    render::FilmImage film;
    std::optional<std::vector<glm::vec3>> denoised;
    float exposure = 1; // of the scene's film
    scene::Development development; // likewise
    glm::vec4 window{0, 1, 0, 1}; // likewise: Film::crop
    std::string denoiser = "none"; // that made `denoised`: "oidn high"
};

struct PictureOptions {
    std::string aovs = "all"; // comma-separated aov_names(), or all, or none
    float exposure_stops = 0; // PNG and JPEG only
    std::map<std::string, std::string> metadata;
};
// The layers that an .exr can have besides the picture: stderr, albedo, ...
std::vector<std::string> aov_names();
// Known layer names separated by commas, or all, or none; the error lists them.
Result<void> check_aovs(const std::string& aovs);
// Checks, before hours of rendering, that a picture can be written there.
Result<void> check_picture_path(const std::string& path);
// .exr: the picture, the requested layers and metadata. .png, .jpg: developed. .pfm, .hdr: the picture.
// The same picture and options give the same bytes.
Result<void> write_picture(const std::string& path, const Picture& picture, const PictureOptions& options);

// As .png or .jpg, by the extension: `rgba` has width * height pixels, red in the lowest byte; .jpg has no alpha.
Result<void> write_rgba(const std::string& path, std::uint32_t width, std::uint32_t height,
                        std::span<const std::uint32_t> rgba);

} // namespace restage::view

// SPDX-License-Identifier: Apache-2.0
// Film: sums, sums of squares and counts a pixel, and guide images. Every image knows its own error.
#pragma once

#include "gpu/device.hpp"
#include "shared/path_data.h"

#include <glm/glm.hpp>
#include <vector>

namespace restage::render {

// What a film holds, normalised; row 0 on top. Sizes are width * height.
struct FilmImage {
    std::uint32_t width = 0, height = 0;
    std::uint32_t samples = 0;           // the least a pixel has
    std::vector<glm::vec3> color;        // linear sRGB radiance, exposure not applied
    std::vector<glm::vec3> std_error; // of the mean, a channel; samples taken as independent, so an upper bound for
                                      // stratified ones. 0 with less than 2 samples
    std::vector<float> luminance_variance; // of the mean
    // Of the first hit that is no mirror or smooth glass, for the denoiser.
    std::vector<glm::vec3> albedo; // [0,1], times what the mirrors and glasses let through
    std::vector<glm::vec3> normal; // world space, shading, mean over samples (not unit at edges)
    std::vector<float> depth; // mean distance of the first hit; 0 = nothing
    std::vector<std::uint32_t> instance_id, material_id; // Id::value seen by the first sample; 0 = nothing

    static FilmImage blank(std::uint32_t width, std::uint32_t height); // all zeros
};

class Film {
  public:
    static Result<Film> create(gpu::Device& device, std::uint32_t width, std::uint32_t height);
    void clear();
    std::uint32_t width() const { return width_; }
    std::uint32_t height() const { return height_; }
    std::uint64_t pixels() const { return pixels_.address(); }
    std::uint64_t guides() const { return guides_.address(); }
    FilmImage read() const;
    std::uint32_t least_samples() const; // of any pixel
    // Root mean square over pixels of (standard error of luminance / (luminance + 0.01)), what --error stops at.
    double relative_error() const;

  private:
    std::uint32_t width_ = 0, height_ = 0;
    gpu::Buffer pixels_, guides_;
};

} // namespace restage::render

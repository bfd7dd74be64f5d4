// SPDX-License-Identifier: Apache-2.0
// Film: sums, sums of squares and counts per pixel, and guide images. Every image knows its own error: some pixels are
// rendered a second time (shared/twins.h).
#pragma once

#include "gpu/device.hpp"
#include "render/film_layers.hpp"
#include "shared/path_data.h"

#include <cstdint>

namespace restage::render {

class Film {
  public:
    static Result<Film> create(gpu::Device& device, std::uint32_t width, std::uint32_t height);
    void clear();
    std::uint32_t width() const { return width_; }
    std::uint32_t height() const { return height_; }
    std::uint32_t rows() const; // to render: the height, and the rows of twins below
    std::uint64_t pixels() const { return pixels_.address(); }
    std::uint64_t guides() const { return guides_.address(); }
    FilmImage read() const;
    std::uint32_t samples_of(std::size_t pixel) const; // of the film, row by row, and of its twins
    std::uint32_t least_samples() const, most_samples() const; // over all pixels
    // As relative_error() of its image (film_error.hpp).
    double relative_error() const;

  private:
    std::uint32_t width_ = 0, height_ = 0;
    gpu::Buffer pixels_, guides_;
};

} // namespace restage::render

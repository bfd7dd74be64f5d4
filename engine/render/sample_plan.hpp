// SPDX-License-Identifier: Apache-2.0
// SamplePlan: the samples that a TraceRequest asks for, in waves.
#pragma once

#include "render/tracer.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace restage::render {

class SamplePlan {
  public:
    // `pixels`: of the film and its twins. A wave has up to `most` samples, and up to `most_per_pixel` of one pixel.
    // The request's spans must outlive the plan.
    SamplePlan(const TraceRequest& request, std::uint32_t pixels, std::uint32_t most, std::uint32_t most_per_pixel);

    bool next(); // goes to the next wave; false: there is none
    std::span<const shared::SamplePick> picks() const { return picks_; }
    std::span<const shared::SampleRun> runs() const { return runs_; } // one per pixel, in order

  private:
    PixelSamples of(std::uint32_t pixel) const;

    const TraceRequest& request_;
    std::uint32_t pixels_, most_, longest_ = 0;
    std::uint32_t per_pixel_ = 1; // in a round over the film
    std::uint32_t taken_ = 0; // samples of each pixel in earlier rounds
    std::uint32_t at_ = 0; // pixel
    std::vector<shared::SamplePick> picks_;
    std::vector<shared::SampleRun> runs_;
};

} // namespace restage::render

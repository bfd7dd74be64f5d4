// SPDX-License-Identifier: Apache-2.0
// Adaptive sampling: how many samples each pixel of a film has when their mean is given.
//
// After `adaptive_pilot` samples of every pixel, each pixel's relative error is estimated from the pilot samples of its
// neighbours, without its own, and numbers of samples become proportional to it (Neyman 1934, optimal allocation). So
// what a pixel measured has no influence on how often it is measured, and its mean stays unbiased (Kirk and Arvo 1991,
// "Unbiased sampling techniques for image synthesis"), but for the common factor, on which one pixel of n has 1/n of
// the influence.
#pragma once

#include "render/film.hpp"
#include "render/tracer.hpp"

#include <cstdint>
#include <vector>

namespace restage::render {

inline constexpr std::uint32_t adaptive_pilot = 16; // samples per pixel

class AdaptivePlan {
  public:
    AdaptivePlan() = default; // empty
    // The film has adaptive_pilot samples of each pixel.
    explicit AdaptivePlan(const Film& film);
    bool empty() const { return noise_.empty(); }

    // Samples of each pixel of the film, then of its twins, when their mean over the film is `mean`, rounded up.
    // At least adaptive_pilot; a larger mean takes none away.
    std::vector<std::uint32_t> counts(std::uint32_t mean) const;

  private:
    double factor(double mean) const; // samples per noise

    std::vector<float> noise_; // relative standard error of one sample, of each pixel and twin
    std::vector<double> sorted_, sums_; // noise of the film's pixels, largest first, and its running sums
};

} // namespace restage::render

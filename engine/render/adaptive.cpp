// SPDX-License-Identifier: Apache-2.0
#include "render/adaptive.hpp"

#include "render/film_error.hpp"
#include "shared/twins.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace restage::render {
namespace {

constexpr int radius = 3; // of the neighbourhood [pixel]
constexpr double dark = 0.01; // luminance below which errors are not relative, as in relative_error
// Of the film's mean square that every pixel's has: what 16 samples of 48 neighbours have not met may still be there.
constexpr double least = 0.1;

struct Pixel {
    double light = 0, variance = 0; // luminance: of the mean, and of one sample
};

// The square of the relative error of one sample, by the neighbours of (x, y).
double noise_nearby(const std::vector<Pixel>& pixels, int width, int height, int x, int y) {
    double light = 0, variance = 0, weight = 0;
    for (int v = std::max(y - radius, 0); v <= std::min(y + radius, height - 1); ++v)
        for (int u = std::max(x - radius, 0); u <= std::min(x + radius, width - 1); ++u) {
            if (u == x && v == y) continue;
            const double w = 1.0 / ((u - x) * (u - x) + (v - y) * (v - y));
            const Pixel& p = pixels[std::size_t(v) * std::size_t(width) + std::size_t(u)];
            light += w * p.light;
            variance += w * p.variance;
            weight += w;
        }
    return weight > 0 ? variance / weight / std::pow(light / weight + dark, 2) : 0;
}

} // namespace

AdaptivePlan::AdaptivePlan(const Film& film) {
    const FilmImage image = film.read();
    const int width = int(image.width), height = int(image.height);
    std::vector<Pixel> pixels(image.pixels());
    for (std::size_t i = 0; i < pixels.size(); ++i)
        pixels[i] = {luminance(image.color[i]), double(image.luminance_variance[i]) * adaptive_pilot};
    std::vector<double> squares(image.pixels());
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            squares[std::size_t(y) * image.width + std::size_t(x)] = noise_nearby(pixels, width, height, x, y);
    const double mean = std::reduce(squares.begin(), squares.end()) / double(squares.size());
    noise_.reserve(std::size_t(film.width()) * film.rows());
    for (const double square : squares)
        noise_.push_back(float(std::sqrt(square + least * mean)));
    for (std::uint32_t row = 0; row < film.rows() - film.height(); ++row)
        for (std::uint32_t x = 0; x < film.width(); ++x)
            noise_.push_back(noise_[std::size_t(shared::twin_of(x, row, film.height())) * film.width() + x]);

    sorted_.assign(noise_.begin(), noise_.begin() + std::ptrdiff_t(image.pixels()));
    std::ranges::sort(sorted_, std::greater());
    sums_.resize(sorted_.size());
    std::partial_sum(sorted_.begin(), sorted_.end(), sums_.begin());
}

// The noisiest k pixels have samples in proportion to their noise, the others keep those of the pilot; of all k, the
// one that fits: there the kth still gets more than the pilot's.
double AdaptivePlan::factor(double mean) const {
    const double n = double(sorted_.size()), extra = n * (mean - adaptive_pilot);
    const auto given = [&](std::size_t k) { return (extra + double(k) * adaptive_pilot) / sums_[k - 1]; };
    std::size_t lower = 1, upper = sorted_.size();
    while (lower < upper) {
        const std::size_t k = (lower + upper + 1) / 2;
        if (given(k) * sorted_[k - 1] >= adaptive_pilot)
            lower = k;
        else
            upper = k - 1;
    }
    return given(lower);
}

std::vector<std::uint32_t> AdaptivePlan::counts(std::uint32_t mean) const {
    std::vector<std::uint32_t> out(noise_.size(), std::max(mean, adaptive_pilot));
    if (mean <= adaptive_pilot || !(sums_.back() > 0)) return out; // without noise there is no need to choose
    const double per_noise = factor(mean);
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = std::uint32_t(std::max(double(adaptive_pilot), std::ceil(per_noise * double(noise_[i]))));
    return out;
}

} // namespace restage::render

// SPDX-License-Identifier: Apache-2.0
#include "render/film_error.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace restage::render {
namespace {

constexpr std::size_t twins_radius = 16; // of the neighbourhood [pixel]: some 34 twins
constexpr double prior = 16;       // twins for which the whole film's ratio counts in it
constexpr double enough = 64; // twins; with fewer of them, that samples are independent counts for up to 8 of them
constexpr double least_ratio = 1e-3;
// Where the spread is larger than this times that of the neighbourhood, it is by a few bright samples, and
// stratification does not help against those.
constexpr double outlier = 2;
constexpr std::size_t light_radius = 2; // [pixel]: of the neighbourhood that tells a noisy pixel's luminance
constexpr double believed = 2; // standard errors, by which a pixel's luminance may differ from what it measured

struct Sum {
    double sum = 0, count = 0;
    Sum& operator+=(const Sum& s) {
        sum += s.sum;
        count += s.count;
        return *this;
    }
    Sum& operator-=(const Sum& s) {
        sum -= s.sum;
        count -= s.count;
        return *this;
    }
};

// Sums over a window that slides along a line of n values `stride` apart.
void slide(const Sum* values, Sum* sums, std::size_t n, std::size_t stride, std::size_t radius) {
    Sum window;
    for (std::size_t i = 0; i < std::min(radius, n); ++i)
        window += values[i * stride];
    for (std::size_t i = 0; i < n; ++i) {
        if (i + radius < n) window += values[(i + radius) * stride];
        if (i > radius) window -= values[(i - radius - 1) * stride];
        sums[i * stride] = window;
    }
}

// Replaces each value by the sum over its neighbourhood, itself included.
void sum_nearby(std::vector<Sum>& values, std::size_t width, std::size_t height, std::size_t radius) {
    std::vector<Sum> along(values.size());
    for (std::size_t y = 0; y < height; ++y)
        slide(&values[y * width], &along[y * width], width, 1, radius);
    for (std::size_t x = 0; x < width; ++x)
        slide(&along[x], &values[x], height, width, radius);
}

} // namespace

double luminance(const glm::dvec3& c) { return glm::dot(c, glm::dvec3(0.2126, 0.7152, 0.0722)); }

void correct_errors(FilmImage& film) {
    const std::size_t n = film.pixels();
    std::vector<Sum> spread(n), ratio(n);
    for (std::size_t i = 0; i < n; ++i)
        spread[i] = {std::sqrt(double(film.luminance_variance[i])), 1};
    sum_nearby(spread, film.width, film.height, twins_radius);
    const auto largest = [&](std::size_t i) { return std::pow(outlier * spread[i].sum / spread[i].count, 2); };
    Sum all;
    for (std::size_t i = 0; i < n; ++i) {
        const glm::dvec2 twin = film.twin[i];
        const double own = film.luminance_variance[i], its = twin.y * twin.y;
        if (!(twin.y > 0) || !(own + its > 1e-30) || std::max(own, its) > largest(i)) continue;
        ratio[i] = {std::pow(luminance(film.color[i]) - twin.x, 2) / (own + its), 1};
        all += ratio[i];
    }
    sum_nearby(ratio, film.width, film.height, twins_radius);
    const double unknown = std::max(0.0, enough - all.count) / 8;
    const double overall = all.count + unknown > 0 ? (all.sum + unknown) / (all.count + unknown) : 1;
    for (std::size_t i = 0; i < n; ++i) {
        const double variance = film.luminance_variance[i];
        if (!(variance > 0)) continue;
        const double nearby = std::max(least_ratio, (ratio[i].sum + prior * overall) / (ratio[i].count + prior));
        const double less = (1 - nearby) * std::min(variance, largest(i)); // by stratification
        film.luminance_variance[i] = float(variance - less);
        film.std_error[i] = film.sample_error[i] * float(std::sqrt(1 - less / variance));
    }
}

float independent_variance(const FilmImage& film, std::size_t i) {
    const glm::vec3 corrected = film.std_error[i], independent = film.sample_error[i];
    const float a = glm::dot(corrected, corrected), b = glm::dot(independent, independent);
    return a > 0 && b > 0 ? film.luminance_variance[i] * (b / a) : film.luminance_variance[i];
}

// A pixel's own luminance is a bad measure of its error: a firefly raises both, and where the light was not met yet
// both are too small. The mean of its neighbours is independent of it, and is used as far as the pixel's own error
// allows: at an edge it is wrong, but there the pixel's own is precise sooner or later.
double relative_error(const FilmImage& film) {
    if (film.samples < 2) return 1e30;
    std::vector<Sum> nearby(film.pixels());
    for (std::size_t i = 0; i < nearby.size(); ++i)
        nearby[i] = {luminance(film.color[i]), 1};
    sum_nearby(nearby, film.width, film.height, light_radius);
    double sum = 0;
    for (std::size_t i = 0; i < nearby.size(); ++i) {
        const double own = luminance(film.color[i]), variance = film.luminance_variance[i];
        const double others = nearby[i].count > 1 ? (nearby[i].sum - own) / (nearby[i].count - 1) : own;
        const double margin = believed * std::sqrt(variance);
        sum += variance / std::pow(std::max(std::clamp(others, own - margin, own + margin), 0.0) + 0.01, 2);
    }
    return std::sqrt(sum / double(film.pixels()));
}

std::uint32_t next_look(std::uint32_t samples) {
    constexpr std::uint32_t first = 16;
    if (samples < first) return first;
    const std::uint32_t step = std::bit_floor(samples) / 4;
    return (samples / step + 1) * step;
}

} // namespace restage::render

// SPDX-License-Identifier: Apache-2.0
#include "io/sun_disk.hpp"

#include <restage/sky.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace restage::io {

namespace {

constexpr int sub = 16; // samples of coverage per texel and axis

// Upper bound on the stretch of lengths by Clarberg's map: sqrt(4 pi) for equal area, sqrt(2) for the concentric disk
// along the horizon, 1.3 for the disk in the square. [rad per unit of the square]
constexpr double most_stretch = 6.6;

struct Covered {
    std::size_t texel;
    double share;
};

class Search {
  public:
    Search(std::uint32_t width, const Sun& sun) : width_(width), sun_(sun) {}

    // Texels [x, x + size) x [y, y + size), subdivided down to single texels, unless too far away.
    void look(std::uint32_t x, std::uint32_t y, std::uint32_t size) {
        if (x >= width_ || y >= width_) return;
        const glm::dvec3 middle = octahedral_direction(width_, x + 0.5 * size, y + 0.5 * size);
        const double reach = most_stretch * std::numbers::sqrt2 / 2 * size / width_;
        if (size < width_ && angle(middle) > sun_.angular_radius + reach) return;
        if (size == 1) return cover(x, y);
        const std::uint32_t half = size / 2;
        look(x, y, half), look(x + half, y, half), look(x, y + half, half), look(x + half, y + half, half);
    }
    std::vector<Covered> found;

  private:
    double angle(const glm::dvec3& w) const { // acos is imprecise near 0
        return std::atan2(glm::length(glm::cross(w, sun_.direction)), glm::dot(w, sun_.direction));
    }
    void cover(std::uint32_t x, std::uint32_t y) {
        int inside = 0;
        for (int j = 0; j < sub; ++j)
            for (int i = 0; i < sub; ++i)
                inside += angle(octahedral_direction(width_, x + (i + 0.5) / sub, y + (j + 0.5) / sub)) <=
                          sun_.angular_radius;
        if (inside > 0) found.push_back({std::size_t{y} * width_ + x, double(inside) / (sub * sub)});
    }

    const std::uint32_t width_;
    const Sun& sun_;
};

std::size_t nearest_texel(std::uint32_t width, const glm::dvec3& direction) {
    std::size_t best = 0;
    double most = -2;
    for (std::uint32_t y = 0; y < width; ++y)
        for (std::uint32_t x = 0; x < width; ++x)
            if (const double d = glm::dot(octahedral_direction(width, x + 0.5, y + 0.5), direction); d > most)
                most = d, best = std::size_t{y} * width + x;
    return best;
}

} // namespace

double solid_angle(const Sun& sun) {
    const double s = std::sin(sun.angular_radius / 2);
    return 4 * std::numbers::pi * s * s;
}

glm::dvec3 octahedral_direction(std::uint32_t width, double x, double y) {
    glm::dvec3 w;
    restage_sky_direction(width, x, y, &w.x);
    return w;
}

void draw_sun(scene::PixelData& picture, const Sun& sun) {
    std::uint32_t size = 1;
    while (size < picture.width)
        size *= 2;
    Search search(picture.width, sun);
    search.look(0, 0, size);
    if (search.found.empty()) // it lies between the samples of all of them
        search.found.push_back({nearest_texel(picture.width, sun.direction), 1});
    double covered = 0;
    for (const Covered& c : search.found)
        covered += c.share;
    const double texel = 4 * std::numbers::pi / (double(picture.width) * picture.width);
    const double scale = solid_angle(sun) / (covered * texel);
    for (const Covered& c : search.found)
        for (int k = 0; k < 3; ++k)
            picture.values[3 * c.texel + std::size_t(k)] += float(sun.radiance[k] * c.share * scale);
}

scene::PixelData coarse_sky(const scene::PixelData& picture, std::uint32_t width) {
    if (picture.width <= width || picture.width != picture.height || picture.channels != 3) return picture;
    scene::PixelData small{.width = width, .height = width, .channels = 3, .values = {}};
    std::vector<double> sums(std::size_t{width} * width * 3), counts(std::size_t{width} * width);
    for (std::uint32_t y = 0; y < picture.height; ++y)
        for (std::uint32_t x = 0; x < picture.width; ++x) {
            const std::size_t to =
                (std::size_t{y} * width / picture.height) * width + std::size_t{x} * width / picture.width;
            const float* from = &picture.values[3 * (std::size_t{y} * picture.width + x)];
            ++counts[to];
            for (std::size_t k = 0; k < 3; ++k)
                sums[3 * to + k] += from[k];
        }
    small.values.resize(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i)
        small.values[i] = float(sums[i] / counts[i / 3]);
    return small;
}

} // namespace restage::io

// SPDX-License-Identifier: Apache-2.0
#include "view/develop.hpp"

#include <algorithm>
#include <bit>

namespace restage::view {

namespace {

constexpr std::uint32_t octaves = 6;

struct Level {
    std::uint32_t width = 0, height = 0;
    std::vector<glm::vec3> pixels;
};

// Half of the size, rounded up: each pixel from four by four with the weights 1 3 3 1 of a quadratic B-spline, so that
// light spreads alike wherever it falls. Beyond the edges the picture goes on as it is there.
Level halved(std::span<const glm::vec3> from, std::uint32_t width, std::uint32_t height) {
    Level to{(width + 1) / 2, (height + 1) / 2, {}};
    to.pixels.resize(std::size_t(to.width) * to.height);
    std::vector<glm::vec3> row(width + 3); // of four, with one more at the left and two at the right
    glm::vec3* out = to.pixels.data();
    for (std::uint32_t y = 0; y < to.height; ++y) {
        const auto line = [&](std::uint32_t at) { return &from[std::size_t(std::min(at, height - 1)) * width]; };
        const glm::vec3 *a = line(y > 0 ? 2 * y - 1 : 0), *b = line(2 * y), *c = line(2 * y + 1), *d = line(2 * y + 2);
        for (std::uint32_t x = 0; x < width; ++x)
            row[x + 1] = a[x] + d[x] + 3.f * (b[x] + c[x]);
        row.front() = row[1];
        row[width + 1] = row[width + 2] = row[width];
        const glm::vec3* in = row.data();
        for (std::uint32_t x = 0; x < to.width; ++x, in += 2)
            *out++ = (in[0] + in[3] + 3.f * (in[1] + in[2])) * (1 / 64.f);
    }
    return to;
}

// Adds `coarse`, interpolated between the centres of its pixels, to a picture of twice the size.
void add_doubled(const Level& coarse, glm::vec3* fine, std::uint32_t width, std::uint32_t height, float weight) {
    std::vector<glm::vec3> row(coarse.width + 2); // between two of coarse, its ends repeated
    for (std::uint32_t y = 0; y < height; ++y) {
        const std::uint32_t near = y / 2, far = y % 2 ? std::min(near + 1, coarse.height - 1) : near - (near > 0);
        const glm::vec3 *a = &coarse.pixels[std::size_t(near) * coarse.width],
                        *b = &coarse.pixels[std::size_t(far) * coarse.width];
        for (std::uint32_t x = 0; x < coarse.width; ++x)
            row[x + 1] = (a[x] * 0.75f + b[x] * 0.25f) * weight;
        row.front() = row[1];
        row.back() = row[coarse.width];
        for (std::uint32_t x = 0; x < width; ++x) {
            const std::uint32_t at = x / 2 + 1;
            *fine++ += row[at] * 0.75f + row[x % 2 ? at + 1 : at - 1] * 0.25f;
        }
    }
}

} // namespace

std::vector<glm::vec3> bloomed(std::span<const glm::vec3> color, std::uint32_t width, std::uint32_t height,
                               float amount) {
    // One that is not finite would spread.
    constexpr float most = 1e30f;
    std::vector<glm::vec3> out(color.begin(), color.end());
    for (glm::vec3& c : out)
        for (int k = 0; k < 3; ++k)
            c[k] = c[k] > -most ? std::min(c[k], most) : -most;
    // The widest octave has four pixels along the shorter side.
    const int widest = int(std::bit_width(std::min(width, height))) - 3;
    if (widest < 1 || amount <= 0) return out;
    std::vector<Level> levels; // 2, 4, 8 ... pixels wide
    levels.push_back(halved(out, width, height));
    while (int(levels.size()) < widest)
        levels.push_back(halved(levels.back().pixels, levels.back().width, levels.back().height));
    const int narrowest = std::max(widest - int(octaves) + 1, 1);
    for (int i = widest - 1; i > 0; --i) { // each becomes the sum of itself and all wider octaves
        Level& level = levels[std::size_t(i - 1)];
        if (i < narrowest) std::ranges::fill(level.pixels, glm::vec3(0));
        add_doubled(levels[std::size_t(i)], level.pixels.data(), level.width, level.height, 1);
    }
    const float share = amount / float(octaves), scattered = share * float(widest - narrowest + 1);
    for (glm::vec3& c : out)
        c *= 1 - scattered;
    add_doubled(levels[0], out.data(), width, height, share);
    return out;
}

} // namespace restage::view

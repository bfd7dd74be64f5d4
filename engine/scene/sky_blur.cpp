// SPDX-License-Identifier: Apache-2.0
#include "scene/sky_blur.hpp"

#include "base/jobs.hpp"
#include "scene/edits.hpp"
#include "shared/octahedral.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace restage::scene {

namespace {

using glm::dvec3;
constexpr double pi = std::numbers::pi;
constexpr double darkness = 1e-12; // radiance by which the directions of dark texels count

glm::vec3 texel(const PixelData& pixels, std::size_t at) {
    const std::size_t blue = pixels.channels < 3 ? 0 : 1;
    glm::vec3 color(0);
    for (std::size_t c = 0; c < 3; ++c)
        if (const float v = pixels.values[at * pixels.channels + c * blue]; v > 0 && std::isfinite(v))
            color[int(c)] = v;
    return color;
}

dvec3 direction(double theta, double phi) {
    return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

// The sphere in rows of equal height, and each row in cells about as wide as high, with the power that comes from each.
class Cells {
  public:
    struct Cell {
        dvec3 power{0}, toward{0}; // toward: where its power comes from, not unit
        double angle = 0; // [sr]
    };
    explicit Cells(double side) : rows_(std::size_t(std::max(std::ceil(pi / side), 8.0))) {
        for (std::size_t row = 0; row < rows_; ++row) {
            first_.push_back(count_);
            columns_.push_back(
                std::size_t(std::ceil(2 * double(rows_) * std::sin(pi * (double(row) + 0.5) / double(rows_)))));
            count_ += columns_.back();
        }
        cells_.resize(count_);
    }
    void add(const dvec3& d, const dvec3& radiance, double angle) {
        const double theta = std::acos(std::clamp(d.z, -1.0, 1.0));
        double turn = std::atan2(d.y, d.x) / (2 * pi);
        turn -= std::floor(turn);
        const std::size_t row = std::min(std::size_t(theta / pi * double(rows_)), rows_ - 1);
        Cell& cell = cells_[first_[row] + std::min(std::size_t(turn * double(columns_[row])), columns_[row] - 1)];
        cell.power += radiance * angle;
        // A sun stays where it is in a cell.
        cell.toward += d * (angle * (radiance.x + radiance.y + radiance.z + darkness));
        cell.angle += angle;
    }
    // f(cell) for those within `reach` of d, and some beyond.
    template <class F>
    void near(const dvec3& d, double reach, F&& f) const {
        const double theta = std::acos(std::clamp(d.z, -1.0, 1.0)), phi = std::atan2(d.y, d.x);
        const double height = pi / double(rows_);
        const auto low = std::size_t(std::max((theta - reach) / height - 1, 0.0));
        const auto high = std::min(std::size_t(std::max((theta + reach) / height + 1, 0.0)), rows_ - 1);
        // The widest the cap gets in longitude; beyond a pole it goes all around.
        const bool around = theta - reach <= height || theta + reach >= pi - height;
        const double half = around ? pi : std::asin(std::min(std::sin(reach) / std::sin(theta), 1.0));
        for (std::size_t row = low; row <= high; ++row) {
            const auto n = std::ptrdiff_t(columns_[row]);
            std::ptrdiff_t from = 0, to = n - 1;
            if (const double width = 2 * pi / double(n); !around && 2 * half + 3 * width < 2 * pi) {
                from = std::ptrdiff_t(std::floor((phi - half) / width)) - 1;
                to = std::ptrdiff_t(std::floor((phi + half) / width)) + 1;
            }
            for (std::ptrdiff_t x = from; x <= to; ++x)
                f(cells_[first_[row] + std::size_t((x % n + n) % n)]);
        }
    }
    const std::vector<Cell>& all() const { return cells_; }

  private:
    std::size_t rows_, count_ = 0;
    std::vector<std::size_t> first_, columns_;
    std::vector<Cell> cells_;
};

// Each texel, in parts no larger than a cell.
Cells gathered(const PixelData& pixels, Mapping mapping, double side) {
    Cells cells(side);
    const double w = pixels.width, h = pixels.height;
    const bool square = mapping == Mapping::octahedral;
    const double texel_side = square ? std::sqrt(4 * pi / (w * h)) : pi / h;
    const auto parts = std::uint32_t(std::ceil(std::max(2 * texel_side / side, 1.0)));
    for (std::uint32_t y = 0; y < pixels.height * parts; ++y) {
        const double v0 = y / (h * parts), v1 = (y + 1) / (h * parts), v = (v0 + v1) / 2;
        const double row = square ? 4 * pi / (h * parts) : 2 * pi * (std::cos(pi * v0) - std::cos(pi * v1)); // [sr]
        for (std::uint32_t x = 0; x < pixels.width * parts; ++x) {
            const double u = (x + 0.5) / (w * parts);
            const dvec3 d = square ? shared::octahedral_to_direction(glm::dvec2(u, v)) : direction(pi * v, 2 * pi * u);
            cells.add(d, dvec3(texel(pixels, std::size_t(y / parts) * pixels.width + x / parts)), row / (w * parts));
        }
    }
    return cells;
}

} // namespace

PixelData blurred_sky(const PixelData& pixels, Mapping mapping, double degrees) {
    const double sigma = glm::radians(degrees), reach = std::min(4 * sigma, pi);
    const Cells cells = gathered(pixels, mapping, sigma / 3);
    const auto side = std::uint32_t(std::clamp(std::ceil(2 * std::sqrt(4 * pi) / sigma), 16.0, 1024.0));
    PixelData out{
        .width = side, .height = side, .channels = 3, .values = std::vector<float>(3 * std::size_t(side) * side)};
    std::vector<dvec3> blurred(std::size_t(side) * side);
    Jobs jobs;
    jobs.parallel_for(blurred.size(), side, [&](std::size_t begin, std::size_t end, unsigned) {
        for (std::size_t i = begin; i < end; ++i) {
            const dvec3 d = shared::octahedral_to_direction(glm::dvec2(double(i % side) + 0.5, double(i / side) + 0.5) /
                                                            double(side));
            dvec3 sum(0);
            double weights = 0;
            cells.near(d, reach, [&](const Cells::Cell& cell) {
                if (!(cell.angle > 0)) return;
                const double weight = std::exp((glm::dot(d, glm::normalize(cell.toward)) - 1) / (sigma * sigma));
                sum += weight * cell.power;
                weights += weight * cell.angle;
            });
            if (weights > 0) blurred[i] = sum / weights;
        }
    });
    dvec3 power(0), now(0);
    for (const Cells::Cell& cell : cells.all())
        power += cell.power / (4 * pi);
    for (const dvec3& color : blurred)
        now += color / double(blurred.size());
    for (std::size_t i = 0; i < blurred.size(); ++i)
        for (int c = 0; c < 3; ++c) // what the grids lose or gain
            out.values[3 * i + std::size_t(c)] = float(now[c] > 0 ? blurred[i][c] * (power[c] / now[c]) : 0);
    return out;
}

Result<Edit> blur_sky(const Scene& scene, double degrees) {
    const auto& now = scene.environment.value;
    const Image* image = now ? scene.images.find(now->image) : nullptr;
    if (!image) return fail("the sky has no image to blur");
    if (!image->data) return fail("the sky's image \"" + image->name + "\" was not read");
    if (!(degrees >= least_blur && degrees <= 180)) return fail("a sky is blurred by 0.5 to 180 degrees");
    return set_blurred_sky(scene, blurred_sky(*image->data, now->mapping, degrees));
}

Edit set_blurred_sky(const Scene& scene, PixelData blurred) {
    Environment sky = *scene.environment.value;
    const Image* image = scene.images.find(sky.image);
    sky.image = scene.images.next();
    sky.mapping = Mapping::octahedral;
    forget_edited(sky.origin, "*");
    Edit edit = insert(scene,
                       Image{.name = (image ? image->name : sky.name) + " blurred",
                             .encoding = Encoding::linear,
                             .data = std::make_shared<const PixelData>(std::move(blurred))},
                       "Blur sky");
    const Edit change = set_environment(scene, sky);
    edit.changes.insert(edit.changes.end(), change.changes.begin(), change.changes.end());
    return edit;
}

} // namespace restage::scene

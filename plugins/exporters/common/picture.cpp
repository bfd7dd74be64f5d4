// SPDX-License-Identifier: Apache-2.0
// The octahedral mapping: P. Clarberg, "Fast equal-area mapping of the (hemi)sphere using SIMD", JGT 13(3), 2008, as in
// pbrt-v4.
#include "common/picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace restage::exporters {

namespace {

constexpr double pi = std::numbers::pi;

struct Direction {
    double x, y, z;
};

// pbrt-v4 EqualAreaSquareToSphere: (u, v) in [0,1]^2.
Direction from_octahedral(double px, double py) {
    const double u = 2 * px - 1, v = 2 * py - 1;
    const double up = std::abs(u), vp = std::abs(v);
    const double signed_distance = 1 - (up + vp), d = std::abs(signed_distance), r = 1 - d;
    const double phi = (r == 0 ? 1 : (vp - up) / r + 1) * pi / 4;
    const double z = std::copysign(1 - r * r, signed_distance);
    const double s = r * std::sqrt(std::max(0.0, 2 - r * r));
    return {std::copysign(std::cos(phi), u) * s, std::copysign(std::sin(phi), v) * s, z};
}

// pbrt-v4 EqualAreaSphereToSquare, with the exact arc tangent.
std::array<double, 2> octahedral_of(Direction w) {
    const double x = std::abs(w.x), y = std::abs(w.y), z = std::abs(w.z);
    const double r = std::sqrt(std::max(0.0, 1 - z));
    const double phi = x == 0 && y == 0 ? 0 : std::atan2(std::min(x, y), std::max(x, y)) * 2 / pi;
    double v = (x < y ? 1 - phi : phi) * r, u = r - v;
    if (w.z < 0) {
        std::swap(u, v);
        u = 1 - u;
        v = 1 - v;
    }
    return {(std::copysign(u, w.x) + 1) / 2, (std::copysign(v, w.y) + 1) / 2};
}

// pbrt-v3: u = phi / 2 pi, v = theta / pi, z up.
Direction from_equirect(double u, double v) {
    const double phi = 2 * pi * u, theta = pi * v, s = std::sin(theta);
    return {s * std::cos(phi), s * std::sin(phi), std::cos(theta)};
}
std::array<double, 2> equirect_of(Direction w) {
    const double phi = std::atan2(w.y, w.x);
    return {(phi < 0 ? phi + 2 * pi : phi) / (2 * pi), std::acos(std::clamp(w.z, -1.0, 1.0)) / pi};
}

class Picture {
  public:
    explicit Picture(const RestageImage& image, bool wraps) : i_(image), wraps_(wraps) {}
    void add_bilinear(double u, double v, double weight, float out[3]) const {
        const double x = u * i_.width - 0.5, y = v * i_.height - 0.5;
        const auto x0 = static_cast<long>(std::floor(x)), y0 = static_cast<long>(std::floor(y));
        const double fx = x - static_cast<double>(x0), fy = y - static_cast<double>(y0);
        for (long dy = 0; dy < 2; ++dy)
            for (long dx = 0; dx < 2; ++dx) {
                const double w = weight * (dx ? fx : 1 - fx) * (dy ? fy : 1 - fy);
                const float* pixel = at(x0 + dx, y0 + dy);
                for (int c = 0; c < 3; ++c)
                    out[c] += static_cast<float>(w * static_cast<double>(i_.channels == 1 ? pixel[0] : pixel[c]));
            }
    }

  private:
    const float* at(long x, long y) const {
        const auto width = static_cast<long>(i_.width), height = static_cast<long>(i_.height);
        x = wraps_ ? (x % width + width) % width : std::clamp(x, 0l, width - 1);
        y = std::clamp(y, 0l, height - 1);
        return i_.pixels + static_cast<std::size_t>(y * width + x) * i_.channels;
    }
    const RestageImage& i_;
    bool wraps_;
};

} // namespace

OwnPicture resampled(const RestageImage& image, bool to_octahedral, std::uint32_t least_side) {
    // About as many pixels as before, with 4 x 4 samples each, so that narrow lights keep their energy.
    const auto side =
        std::max(least_side, static_cast<std::uint32_t>(std::lround(std::sqrt(double(image.width) * image.height))));
    OwnPicture out;
    out.width =
        to_octahedral ? side : std::max(2u, static_cast<std::uint32_t>(std::lround(double(side) * std::sqrt(2.0))));
    out.height = to_octahedral ? side : std::max(1u, out.width / 2);
    const Picture from(image, to_octahedral);
    constexpr int samples = 4;
    out.pixels.resize(std::size_t{out.width} * out.height * 3);
    for (std::uint32_t y = 0; y < out.height; ++y)
        for (std::uint32_t x = 0; x < out.width; ++x)
            for (int s = 0; s < samples * samples; ++s) {
                const double u = (x + (s % samples + 0.5) / samples) / out.width,
                             v = (y + (s / samples + 0.5) / samples) / out.height;
                const auto at = to_octahedral ? equirect_of(from_octahedral(u, v)) : octahedral_of(from_equirect(u, v));
                from.add_bilinear(at[0], at[1], 1.0 / (samples * samples),
                                  &out.pixels[(std::size_t{y} * out.width + x) * 3]);
            }
    return out;
}

std::string pfm_bytes(const RestageImage& image) {
    const std::uint32_t channels = image.channels == 1 ? 1 : 3;
    std::string out =
        (channels == 1 ? "Pf\n" : "PF\n") + std::to_string(image.width) + " " + std::to_string(image.height) + "\n-1\n";
    for (std::uint32_t row = image.height; row-- > 0;)
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const float* pixel = image.pixels + (std::size_t{row} * image.width + x) * image.channels;
            out.append(reinterpret_cast<const char*>(pixel), channels * sizeof(float));
        }
    return out;
}

} // namespace restage::exporters

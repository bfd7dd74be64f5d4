// SPDX-License-Identifier: Apache-2.0
// The z-test over blocks of luminance: whether two pictures are equal up to their known noise.

#include "io/image_compare.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

namespace restage::io {

namespace {

struct Blocks {
    std::uint32_t width, height, block;
    std::uint32_t columns() const { return (width + block - 1) / block; }
    std::uint32_t rows() const { return (height + block - 1) / block; }

    // f(index of the pixel) for the pixels of block (column, row).
    template <class F>
    void each(std::uint32_t column, std::uint32_t row, F&& f) const {
        const std::uint32_t x1 = std::min((column + 1) * block, width), y1 = std::min((row + 1) * block, height);
        for (std::uint32_t y = row * block; y < y1; ++y)
            for (std::uint32_t x = column * block; x < x1; ++x)
                f(std::size_t{y} * width + x);
    }
};

} // namespace

Result<Estimate> estimate_of_halves(const scene::PixelData& half1, const scene::PixelData& half2, std::uint32_t block) {
    if (half1.width != half2.width || half1.height != half2.height)
        return fail(fmt::format("the halves differ in size: {} x {} and {} x {}", half1.width, half1.height,
                                half2.width, half2.height));
    if (half1.width == 0 || half1.height == 0 || block == 0) return fail("the halves have no pixels");
    const auto l1 = luminance(half1), l2 = luminance(half2);
    Estimate result{.width = half1.width, .height = half1.height};
    result.luminance.resize(l1.size());
    result.variance.resize(l1.size());
    const Blocks blocks{half1.width, half1.height, block};
    for (std::uint32_t row = 0; row < blocks.rows(); ++row)
        for (std::uint32_t column = 0; column < blocks.columns(); ++column) {
            double sum = 0;
            std::size_t count = 0;
            blocks.each(column, row, [&](std::size_t i) {
                const double difference = static_cast<double>(l1[i]) - l2[i];
                sum += difference * difference / 4; // variance of the mean of two, with one degree of freedom
                ++count;
            });
            blocks.each(column, row, [&](std::size_t i) {
                result.luminance[i] = 0.5f * (l1[i] + l2[i]);
                result.variance[i] = static_cast<float>(sum / static_cast<double>(count));
            });
        }
    return result;
}

Result<ZTest> z_test(const Estimate& a, const Estimate& b, double threshold, std::uint32_t block) {
    if (a.width != b.width || a.height != b.height)
        return fail(
            fmt::format("the pictures differ in size: {} x {} and {} x {}", a.width, a.height, b.width, b.height));
    const std::size_t pixels = std::size_t{a.width} * a.height;
    for (const auto* e : {&a, &b})
        if (e->luminance.size() != pixels || e->variance.size() != pixels || pixels == 0)
            return fail("z-test: luminance and variance must have a value for every pixel");
    const Blocks blocks{a.width, a.height, block};
    ZTest test{.columns = blocks.columns(), .rows = blocks.rows(), .threshold = threshold};
    std::size_t passing = 0;
    double squares = 0;
    for (std::uint32_t row = 0; row < test.rows; ++row)
        for (std::uint32_t column = 0; column < test.columns; ++column) {
            double difference = 0, variance = 0; // n times the mean's; n^2 times the mean's
            blocks.each(column, row, [&](std::size_t i) {
                const double la = a.luminance[i], lb = b.luminance[i];
                const double rounding = variance_floor * std::max(la * la, lb * lb);
                difference += la - lb;
                variance += std::max(static_cast<double>(a.variance[i]) + b.variance[i], rounding);
            });
            const double z = variance > 0 ? difference / std::sqrt(variance) : difference == 0 ? 0 : HUGE_VAL;
            test.z.push_back(static_cast<float>(z));
            passing += std::abs(z) <= threshold;
            test.worst = std::max(test.worst, std::abs(z));
            squares += z * z;
        }
    const auto count = static_cast<double>(test.z.size());
    test.share_passing = static_cast<double>(passing) / count;
    test.rms = std::sqrt(squares / count);
    test.family_threshold = inverse_normal(1 - 0.01 / (2 * count));
    test.family_passes = test.worst <= test.family_threshold;
    return test;
}

double inverse_normal(double p) {
    // Acklam's rational approximation (2003, relative error 1.15e-9), by the symmetry of the lower half.
    if (!(p > 0)) return -HUGE_VAL;
    if (!(p < 1)) return HUGE_VAL;
    if (p > 0.5) return -inverse_normal(1 - p);
    static constexpr double a[] = {-3.969683028665376e+01, 2.209460984245205e+02,  -2.759285104469687e+02,
                                   1.383577518672690e+02,  -3.066479806614716e+01, 2.506628277459239e+00};
    static constexpr double b[] = {-5.447609879822406e+01, 1.615858368580409e+02, -1.556989798598866e+02,
                                   6.680131188771972e+01, -1.328068155288572e+01};
    static constexpr double c[] = {-7.784894002430293e-03, -3.223964580411365e-01, -2.400758277161838e+00,
                                   -2.549732539343734e+00, 4.374664141464968e+00,  2.938163982698783e+00};
    static constexpr double d[] = {7.784695709041462e-03, 3.224671290700398e-01, 2.445134137142996e+00,
                                   3.754408661907416e+00};
    if (p < 0.02425) {
        const double q = std::sqrt(-2 * std::log(p));
        return (((((c[0] * q + c[1]) * q + c[2]) * q + c[3]) * q + c[4]) * q + c[5]) /
               ((((d[0] * q + d[1]) * q + d[2]) * q + d[3]) * q + 1);
    }
    const double q = p - 0.5, r = q * q;
    return (((((a[0] * r + a[1]) * r + a[2]) * r + a[3]) * r + a[4]) * r + a[5]) * q /
           (((((b[0] * r + b[1]) * r + b[2]) * r + b[3]) * r + b[4]) * r + 1);
}

} // namespace restage::io

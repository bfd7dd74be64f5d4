// SPDX-License-Identifier: Apache-2.0
// Means and errors of picture pairs, firefly clipping, difference picture.

#include "io/image_compare.hpp"

#include "io/image_file.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cassert>
#include <cmath>

namespace restage::io {

namespace {

std::size_t pixel_count(const scene::PixelData& image) { return std::size_t{image.width} * image.height; }

// Channel c of pixel i; grey serves for all three.
float value(const scene::PixelData& image, std::size_t i, std::size_t c) {
    return image.values[i * image.channels + (image.channels < 3 ? 0 : c)];
}

Result<> check_pair(const scene::PixelData& a, const scene::PixelData& b) {
    if (pixel_count(a) == 0) return fail("the first picture has no pixels");
    if (a.width != b.width || a.height != b.height)
        return fail(
            fmt::format("the pictures differ in size: {} x {} and {} x {}", a.width, a.height, b.width, b.height));
    return {};
}

// Exposure, then clamped to what a screen can show: FLIP's input.
scene::PixelData displayed(const scene::PixelData& image, float exposure) {
    scene::PixelData out{.width = image.width, .height = image.height, .channels = 3};
    out.values.resize(pixel_count(image) * 3);
    const float factor = std::exp2(exposure);
    for (std::size_t i = 0; i < out.values.size(); ++i)
        out.values[i] = std::clamp(value(image, i / 3, i % 3) * factor, 0.f, 1.f);
    return out;
}

} // namespace

std::vector<float> luminance(const scene::PixelData& image) {
    std::vector<float> result(pixel_count(image));
    for (std::size_t i = 0; i < result.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            result[i] += luminance_weights[c] * value(image, i, c);
    return result;
}

float clip_fireflies(scene::PixelData& a, scene::PixelData& b, float share) {
    if (!(share > 0)) return 0;
    std::vector<float> all = luminance(a);
    const std::vector<float> of_b = luminance(b);
    all.insert(all.end(), of_b.begin(), of_b.end());
    if (all.empty()) return 0;
    const double rank = (1 - std::min(share, 1.f)) * static_cast<double>(all.size() - 1);
    const auto nth = all.begin() + static_cast<std::ptrdiff_t>(rank);
    std::nth_element(all.begin(), nth, all.end());
    const float limit = *nth;
    if (!(limit > 0)) return 0;
    for (auto* image : {&a, &b}) {
        const auto lum = luminance(*image);
        for (std::size_t i = 0; i < lum.size(); ++i)
            if (lum[i] > limit)
                for (std::size_t c = 0; c < std::min<std::size_t>(image->channels, 3); ++c)
                    image->values[i * image->channels + c] *= limit / lum[i];
    }
    return limit;
}

Result<Comparison> compare_images(const scene::PixelData& original_a, const scene::PixelData& original_b,
                                  const CompareOptions& options) {
    RESTAGE_CHECK(check_pair(original_a, original_b));
    scene::PixelData a = original_a, b = original_b;
    Comparison result{.clip_luminance = clip_fireflies(a, b, options.clip)};
    const std::size_t count = pixel_count(a);
    double squares = 0, relative = 0;
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const double va = value(a, i, c), vb = value(b, i, c), square = (va - vb) * (va - vb);
            result.mean_a[c] += va;
            result.mean_b[c] += vb;
            squares += square;
            relative += square / (vb * vb + rel_mse_epsilon);
        }
    for (std::size_t c = 0; c < 3; ++c) {
        result.mean_a[c] /= static_cast<double>(count);
        result.mean_b[c] /= static_cast<double>(count);
        result.luminance_a += luminance_weights[c] * result.mean_a[c];
        result.luminance_b += luminance_weights[c] * result.mean_b[c];
    }
    result.rmse = std::sqrt(squares / (3.0 * static_cast<double>(count)));
    result.rel_mse = relative / (3.0 * static_cast<double>(count));
    double flip = 0;
    for (const float error : flip_map(displayed(b, options.exposure), displayed(a, options.exposure)))
        flip += error;
    result.flip = flip / static_cast<double>(count);
    return result;
}

scene::PixelData difference_image(const scene::PixelData& a, const scene::PixelData& b, float range) {
    assert(pixel_count(a) == pixel_count(b) && range > 0);
    const auto la = luminance(a), lb = luminance(b);
    double mean = 0;
    for (const float v : lb)
        mean += v;
    mean /= static_cast<double>(std::max<std::size_t>(lb.size(), 1));
    const float guard = std::max(0.1f * static_cast<float>(mean), 1e-6f);
    scene::PixelData image{.width = a.width, .height = a.height, .channels = 3};
    image.values.resize(la.size() * 3);
    for (std::size_t i = 0; i < la.size(); ++i) {
        const float error = (la[i] - lb[i]) / (std::max(lb[i], 0.f) + guard) / range;
        // Perceptually linear; over-range continues to yellow and cyan, to stand out.
        image.values[3 * i] = srgb_to_linear(std::clamp(error, 0.f, 1.f));
        image.values[3 * i + 1] = srgb_to_linear(std::clamp((std::abs(error) - 1) / 3, 0.f, 1.f));
        image.values[3 * i + 2] = srgb_to_linear(std::clamp(-error, 0.f, 1.f));
    }
    return image;
}

} // namespace restage::io

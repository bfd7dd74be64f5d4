// SPDX-License-Identifier: Apache-2.0
// Comparison of pictures: closed forms of each measure, and the z-test on noise whose variance is known.
// FLIP against its authors' program: tests/scripts/test_flip.py.
#include "io/image_compare.hpp"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <random>

using namespace restage;
using Catch::Approx;

namespace {

scene::PixelData flat(unsigned width, unsigned height, std::array<float, 3> color) {
    scene::PixelData image{.width = width, .height = height, .channels = 3};
    for (unsigned i = 0; i < width * height; ++i)
        image.values.insert(image.values.end(), color.begin(), color.end());
    return image;
}

// A picture with structure, plus noise of the given standard deviation that grows with the signal.
io::Estimate noisy(unsigned seed, float sigma, float bias = 0) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    io::Estimate e{.width = 100, .height = 60};
    for (unsigned y = 0; y < e.height; ++y)
        for (unsigned x = 0; x < e.width; ++x) {
            const float truth = 1 + std::sin(float(x) * 0.2f) * std::cos(float(y) * 0.1f),
                        deviation = sigma * (0.1f + truth);
            e.luminance.push_back(truth + bias + deviation * normal(random));
            e.variance.push_back(deviation * deviation);
        }
    return e;
}

scene::PixelData grey(const io::Estimate& e) {
    return {.width = e.width, .height = e.height, .channels = 1, .values = e.luminance};
}

} // namespace

TEST_CASE("image_compare: means, RMSE and relMSE in closed form") {
    const auto a = flat(10, 7, {1.0f, 0.5f, 0.25f}), b = flat(10, 7, {0.5f, 0.5f, 0.5f});
    const auto c = io::compare_images(a, b);
    REQUIRE(c);
    CHECK(c->mean_a[0] == Approx(1));
    CHECK(c->mean_b[2] == Approx(0.5));
    CHECK(c->luminance_a == Approx(0.2126 + 0.7152 * 0.5 + 0.0722 * 0.25));
    CHECK(c->luminance_b == Approx(0.5));
    CHECK(c->rmse == Approx(std::sqrt((0.25 + 0 + 0.0625) / 3)));
    CHECK(c->rel_mse == Approx((0.25 + 0 + 0.0625) / 3 / (0.25 + 0.01)));
    const auto same = io::compare_images(a, a);
    REQUIRE(same);
    CHECK(same->rmse == 0);
    CHECK(same->rel_mse == 0);
    CHECK(same->flip == Approx(0).margin(1e-6));
    CHECK_FALSE(io::compare_images(a, flat(7, 10, {0, 0, 0})));
    CHECK_FALSE(io::compare_images(scene::PixelData{}, scene::PixelData{}));
}

TEST_CASE("image_compare: FLIP of black and white is nearly 1, and grows with the error") {
    const auto black = flat(32, 32, {0, 0, 0}), white = flat(32, 32, {1, 1, 1});
    CHECK(io::compare_images(black, white)->flip > 0.9);
    double last = 0;
    for (const float v : {0.01f, 0.05f, 0.2f, 0.6f}) {
        const double flip = io::compare_images(flat(32, 32, {v, v, v}), black)->flip;
        CHECK(flip > last);
        last = flip;
    }
}

TEST_CASE("image_compare: fireflies clip alike in both") {
    auto a = flat(50, 40, {1, 1, 1}), b = a; // 4000 texels in all
    a.values[0] = a.values[1] = a.values[2] = 1000;
    b.values[300] = b.values[301] = 500; // yellow
    const float limit = io::clip_fireflies(a, b, 0.001f);
    CHECK(limit == 1);
    CHECK(a.values[0] == Approx(1));
    CHECK(b.values[300] == Approx(1 / (0.2126 + 0.7152 + 0.0722 / 500)).epsilon(1e-4)); // keeps its hue
    CHECK(b.values[301] == Approx(b.values[300]));
    CHECK(b.values[302] == Approx(b.values[300] / 500));

    // A lamp larger than the clipped fraction is unchanged.
    auto lamp = flat(50, 40, {1, 1, 1}), same = lamp;
    for (int i = 0; i < 3 * 100; ++i)
        lamp.values[i] = same.values[i] = 40;
    CHECK(io::clip_fireflies(lamp, same, 0.001f) == 40);
    CHECK(lamp.values[0] == 40);
    auto untouched = lamp;
    CHECK(io::clip_fireflies(lamp, same, 0) == 0);
    CHECK(lamp.values == untouched.values);
}

TEST_CASE("image_compare: quantiles of the normal distribution") {
    CHECK(io::inverse_normal(0.5) == Approx(0).margin(1e-9));
    CHECK(io::inverse_normal(0.975) == Approx(1.959963985).epsilon(1e-8));
    CHECK(io::inverse_normal(0.00135) == Approx(-2.99997699).epsilon(1e-6));
    CHECK(io::inverse_normal(1 - 1e-9) == Approx(5.997807).epsilon(1e-6));
}

TEST_CASE("image_compare: z-test passes equal pictures and finds a bias smaller than the noise of a pixel") {
    const auto same = io::z_test(noisy(1, 0.3f), noisy(2, 0.1f));
    REQUIRE(same);
    CHECK(same->columns == 13);
    CHECK(same->rows == 8);
    CHECK(same->z.size() == 13 * 8);
    CHECK(same->share_passing >= 0.97); // 99.73 % expected
    CHECK(same->rms == Approx(1).margin(0.25));
    CHECK(same->family_passes);
    CHECK(same->family_threshold == Approx(io::inverse_normal(1 - 0.005 / (13 * 8))));

    const auto biased = io::z_test(noisy(1, 0.3f, 0.3f), noisy(2, 0.1f)); // about one sigma of one pixel
    REQUIRE(biased);
    CHECK(biased->share_passing < 0.3);
    CHECK_FALSE(biased->family_passes);

    // One bad block among many: not detected by the fraction, but by the test of all blocks.
    auto spot = noisy(1, 0.3f);
    for (unsigned y = 16; y < 24; ++y)
        for (unsigned x = 16; x < 24; ++x)
            spot.luminance[y * 100 + x] += 1.5f;
    const auto one = io::z_test(spot, noisy(2, 0.1f));
    REQUIRE(one);
    CHECK(one->share_passing >= 0.95);
    CHECK_FALSE(one->family_passes);
    CHECK(std::abs(one->z[2 * 13 + 2]) > 5);
}

TEST_CASE("image_compare: z-test in closed form, and without noise") {
    io::Estimate a{.width = 2, .height = 1, .luminance = {3, 5}, .variance = {0.25f, 0.5f}}, b = a;
    b.luminance = {2, 4};
    b.variance = {0.25f, 0};
    auto test = io::z_test(a, b);
    REQUIRE(test);
    REQUIRE(test->z.size() == 1);
    CHECK(test->z[0] == Approx(2 / std::sqrt(1.0))); // mean difference 1, its standard error sqrt(1) / 2
    a.variance = b.variance = {0, 0};
    CHECK(io::z_test(a, a)->worst == 0);
    CHECK(io::z_test(a, b)->share_passing == 0);
    b.luminance.pop_back();
    CHECK_FALSE(io::z_test(a, b));
}

TEST_CASE("image_compare: two halves give their own variance") {
    const auto truth = noisy(0, 0);
    const auto reference = io::estimate_of_halves(grey(noisy(3, 0.2f)), grey(noisy(4, 0.2f)));
    REQUIRE(reference);
    double ratio = 0;
    for (std::size_t i = 0; i < truth.luminance.size(); ++i) {
        const float sigma = 0.2f * (0.1f + truth.luminance[i]);
        ratio +=
            reference->variance[i] / (sigma * sigma / 2) * truth.luminance[i] / 6000; // dark blocks have less weight
    }
    CHECK(ratio == Approx(1).margin(0.15));
    const auto test = io::z_test(noisy(5, 0.3f), *reference);
    REQUIRE(test);
    CHECK(test->share_passing >= 0.97);
    CHECK(test->rms == Approx(1).margin(0.25));
    const auto against_truth = io::z_test(truth, *reference);
    REQUIRE(against_truth);
    CHECK(against_truth->share_passing >= 0.96);
    CHECK_FALSE(io::estimate_of_halves(grey(truth), flat(3, 3, {0, 0, 0})));
}

TEST_CASE("image_compare: the difference picture is signed") {
    const auto base = flat(4, 4, {1, 1, 1}), brighter = flat(4, 4, {1.2f, 1.2f, 1.2f}),
               darker = flat(4, 4, {0.8f, 0.8f, 0.8f});
    const auto up = io::difference_image(brighter, base), down = io::difference_image(darker, base);
    CHECK(up.values[0] > 0.05f);
    CHECK(up.values[2] == 0);
    CHECK(down.values[0] == 0);
    CHECK(down.values[2] > 0.05f);
    for (const float v : io::difference_image(base, base).values)
        CHECK(v == 0);
}

// SPDX-License-Identifier: Apache-2.0
// Development against the published formulas in double precision: tone curves, white balance, vignette, bloom.
#include "view/develop.hpp"

#include "io/image_file.hpp"
#include "scene/color_temperature.hpp"
#include "temporary_folder.hpp"
#include "view/display.hpp"
#include "view/picture.hpp"

#include <catch2/catch_approx.hpp>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

using namespace restage;
using Catch::Approx;
using scene::Development;
using scene::ToneCurve;

namespace {

constexpr ToneCurve all[] = {ToneCurve::srgb, ToneCurve::filmic, ToneCurve::agx, ToneCurve::neutral};

std::vector<glm::ivec3> developed(const std::vector<glm::vec3>& color, std::uint32_t width, const view::Developing& d) {
    std::vector<std::uint32_t> rgba(color.size());
    view::develop(color, width, std::uint32_t(color.size()) / width, d, rgba.data());
    std::vector<glm::ivec3> out;
    for (const std::uint32_t p : rgba) {
        CHECK(p >> 24 == 255);
        out.emplace_back(p & 255, p >> 8 & 255, p >> 16 & 255);
    }
    return out;
}
glm::ivec3 developed(const glm::vec3& color, const Development& how, float factor = 1) {
    return developed({color}, 1, {.how = how, .factor = factor})[0];
}

double encoded(double x) { // IEC 61966-2-1, in 8-bit steps
    x = std::clamp(x, 0.0, 1.0);
    return 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
}

double agx_contrast(double x) { // as in the scripts of AgX-S2O3: equation_full_curve
    const auto scale = [](double px, double py, double power) {
        return std::pow(std::pow(2 * px, -power) * (std::pow(2 * px / py, power) - 1), -1 / power);
    };
    const double pivot = 10 / 16.5;
    const double s = x >= pivot ? scale(1 - pivot, 0.5, 3.25) : -scale(pivot, 0.5, 3), power = x >= pivot ? 3.25 : 3;
    const double term = 2 * (x - pivot) / s;
    return s * term / std::pow(1 + std::pow(term, power), 1 / power) + 0.5;
}
// The fit to it of Wrensch, "Minimal AgX implementation", which Filament and three.js use.
double agx_fit(double x) {
    return ((((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x) - 0.00232;
}
template <class F>
glm::dvec3 agx(const glm::dvec3& c, F&& contrast) { // the rest as in three.js
    const auto dot = [](const glm::dvec3& v, double a, double b, double d) { return a * v.x + b * v.y + d * v.z; };
    const auto curve = [&](double x) {
        return contrast(std::clamp((std::log2(std::max(x, 1e-10)) + 12.47393) / 16.5, 0.0, 1.0));
    };
    const glm::dvec3 wide(dot(c, 0.6274, 0.3293, 0.0433), dot(c, 0.0691, 0.9195, 0.0113),
                          dot(c, 0.0164, 0.088, 0.8956));
    const glm::dvec3 v(curve(dot(wide, 0.856627153315983, 0.0951212405381588, 0.0482516061458583)),
                       curve(dot(wide, 0.137318972929847, 0.761241990602591, 0.101439036467562)),
                       curve(dot(wide, 0.11189821299995, 0.0767994186031903, 0.811302368396859)));
    const glm::dvec3 out(dot(v, 1.1271005818144368, -0.11060664309660323, -0.016493938717834573),
                         dot(v, -0.1413297634984383, 1.157823702216272, -0.016493938717834257),
                         dot(v, -0.14132976349843826, -0.11060664309660294, 1.2519364065950405));
    const glm::dvec3 linear = glm::pow(glm::max(out, 0.0), glm::dvec3(2.2));
    return {dot(linear, 1.6605, -0.5876, -0.0728), dot(linear, -0.1246, 1.1329, -0.0083),
            dot(linear, -0.0182, -0.1006, 1.1187)};
}

// The text of the specification, Khronos PBR Neutral Tone Mapper 1.0.
glm::dvec3 neutral(glm::dvec3 c) {
    const double x = std::min({c.x, c.y, c.z}), f90 = 0.04, ks = 0.8 - f90, kd = 0.15;
    c -= x <= 2 * f90 ? x - x * x / (4 * f90) : f90;
    const double p = std::max({c.x, c.y, c.z});
    if (p <= ks) return c;
    const double pn = 1 - (1 - ks) * (1 - ks) / (p + 1 - 2 * ks), g = 1 / (kd * (p - pn) + 1);
    return c * (pn / p) * g + glm::dvec3(pn) * (1 - g);
}

// The largest difference in 8-bit steps, of colours from 2^-8 to 2^8.
template <class F>
double largest_difference(ToneCurve tone, F&& reference) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> stops(-8, 8);
    std::vector<glm::vec3> colors(4000);
    for (glm::vec3& c : colors)
        c = {std::exp2(stops(random)), std::exp2(stops(random)), std::exp2(stops(random))};
    const auto out = developed(colors, 100, {.how = {.tone = tone}});
    double most = 0;
    for (std::size_t i = 0; i < colors.size(); ++i) {
        const glm::dvec3 wanted = reference(glm::dvec3(colors[i]));
        for (int k = 0; k < 3; ++k)
            most = std::max(most, std::abs(out[i][k] - encoded(wanted[k])));
    }
    return most;
}

std::vector<glm::vec3> point(std::uint32_t side, std::uint32_t x, std::uint32_t y) {
    std::vector<glm::vec3> color(std::size_t(side) * side, glm::vec3(0));
    color[std::size_t(y) * side + x] = {1000, 500, 0};
    return color;
}
glm::dvec3 sum(const std::vector<glm::vec3>& color) {
    return std::accumulate(color.begin(), color.end(), glm::dvec3(0),
                           [](const auto& a, const auto& b) { return a + glm::dvec3(b); });
}

} // namespace

TEST_CASE("development: tone curves agree with their formulas") {
    CHECK(largest_difference(ToneCurve::srgb, [](const glm::dvec3& c) { return c; }) < 1);
    CHECK(largest_difference(ToneCurve::filmic, [](const glm::dvec3& c) {
              return c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14);
          }) < 1);
    CHECK(largest_difference(ToneCurve::neutral, neutral) < 1);
    CHECK(largest_difference(ToneCurve::agx, [](const glm::dvec3& c) { return agx(c, agx_contrast); }) < 2);
    CHECK(largest_difference(ToneCurve::agx, [](const glm::dvec3& c) { return agx(c, agx_fit); }) < 10);
    for (int i = 0; i <= 100; ++i)
        CHECK(std::abs(agx_contrast(i / 100.0) - agx_fit(i / 100.0)) < 0.006);
}

TEST_CASE("development: published values of the curves") {
    // Sobotka's base contrast shows middle grey at half of the code values, for a display of gamma 2.2.
    const double grey = encoded(std::pow(0.5, 2.2));
    CHECK(std::abs(developed(glm::vec3(0.18f), {.tone = ToneCurve::agx}).x - grey) <= 1);
    CHECK(developed(glm::vec3(0.18f * std::exp2(6.5f)), {.tone = ToneCurve::agx}) == glm::ivec3(255));
    // PBR Neutral keeps colours up to 0.8, but for the 4 % that a surface of index 1.5 reflects.
    const glm::vec3 kept(0.8f, 0.3f, 0.5f);
    for (int k = 0; k < 3; ++k)
        CHECK(std::abs(developed(kept, {.tone = ToneCurve::neutral})[k] - encoded(double(kept[k]) - 0.04)) <= 1);
    CHECK(std::abs(developed(glm::vec3(1), {.tone = ToneCurve::neutral}).x - encoded(1 - 0.24 * 0.24 / 0.44)) <= 1);
}

TEST_CASE("development: greys stay grey and in order, black stays black, everything is a colour") {
    std::vector<glm::vec3> greys{glm::vec3(0)};
    for (int i = -400; i <= 400; ++i)
        greys.emplace_back(std::exp2(float(i) / 20));
    constexpr float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
    greys.emplace_back(std::numeric_limits<float>::max());
    greys.emplace_back(inf);
    for (const ToneCurve tone : all) {
        INFO(int(tone));
        const auto out = developed(greys, 1, {.how = {.tone = tone}});
        CHECK(out.front() == glm::ivec3(0));
        CHECK(out.back() == glm::ivec3(255));
        for (std::size_t i = 0; i < out.size(); ++i) {
            CHECK(std::max({out[i].x, out[i].y, out[i].z}) - std::min({out[i].x, out[i].y, out[i].z}) <= 1);
            if (i > 0) CHECK(out[i].y >= out[i - 1].y);
        }
        CHECK(developed(glm::vec3(nan), {.tone = tone}) == glm::ivec3(0));
        CHECK(developed(glm::vec3(-inf), {.tone = tone}) == glm::ivec3(0));
        CHECK(developed(glm::vec3(inf, 0, 0), {.tone = tone}).x > 200);
        const Development much{.tone = tone, .temperature = 2500, .tint = 40, .vignette = 1, .bloom = 0.5f};
        CHECK(developed(glm::vec3(inf), much, 1e10f).z == 255); // bulbs are far from white there
        CHECK(developed(glm::vec3(0), much) == glm::ivec3(0));
    }
}

TEST_CASE("development: PBR Neutral keeps the hue of bright colours") {
    // (middle - least) / (most - least), in linear light, as the encoding does not keep it.
    const auto hue = [](const glm::dvec3& c) { return (c.y - c.z) / (c.x - c.z); };
    for (const float scale : {0.3f, 1.f, 3.f, 10.f}) {
        const glm::ivec3 out = developed(glm::vec3(1, 0.5f, 0.1f), {.tone = ToneCurve::neutral}, scale);
        const auto linear = [](int v) { return double(io::srgb_to_linear(float(v) / 255)); };
        CHECK(hue({linear(out.x), linear(out.y), linear(out.z)}) == Approx(hue({1, 0.5, 0.1})).margin(0.03));
    }
}

TEST_CASE("white balance: light of the chosen temperature becomes white") {
    CHECK(scene::white_balance(6504, 0) == glm::dmat3(1));
    const auto of = [](double kelvin, double tint) { // linear sRGB
        const glm::dvec2 xy = scene::illuminant(kelvin, tint);
        const glm::dmat3 to_xyz = glm::transpose(glm::dmat3(0.4124564, 0.3575761, 0.1804375, 0.2126729, 0.7151522,
                                                            0.0721750, 0.0193339, 0.1191920, 0.9503041));
        return glm::inverse(to_xyz) * glm::dvec3(xy.x / xy.y, 1, (1 - xy.x - xy.y) / xy.y);
    };
    for (const double kelvin : {2000., 2856., 4500., 5003., 6504., 9000., 20000.})
        for (const double tint : {-60., 0., 60.}) {
            INFO(kelvin << " K, tint " << tint);
            const glm::dvec3 white = scene::white_balance(kelvin, tint) * of(kelvin, tint);
            CHECK(white.x == Approx(1).margin(2e-3));
            CHECK(white.y == Approx(1).margin(2e-3));
            CHECK(white.z == Approx(1).margin(2e-3));
        }
    // CIE A and D50; the lights are the tables' to the third digit.
    CHECK(scene::illuminant(2856, 0).x == Approx(0.4476).margin(1e-3));
    CHECK(scene::illuminant(2856, 0).y == Approx(0.4074).margin(1e-3));
    CHECK(scene::illuminant(5003, 0).x == Approx(0.3457).margin(1e-3));
    CHECK(scene::illuminant(5003, 0).y == Approx(0.3585).margin(1e-3));
    CHECK(of(5000, 60).y / of(5000, 60).x > of(5000, 0).y / of(5000, 0).x); // greener
    const glm::ivec3 warm = developed(glm::vec3(0.5f), {.temperature = 10000}),
                     cold = developed(glm::vec3(0.5f), {.temperature = 3500});
    CHECK(warm.x > warm.z);
    CHECK(cold.x < cold.z);
    CHECK(developed(glm::vec3(0.5f), {.tint = 50}).y < developed(glm::vec3(0.5f), {}).y); // pinker
}

TEST_CASE("vignette: a quarter is left in the corners, and a crop shows its part of it") {
    const std::uint32_t width = 64, height = 36;
    const std::vector<glm::vec3> grey(std::size_t(width) * height, glm::vec3(0.8f));
    const Development how{.vignette = 1};
    const auto whole = developed(grey, width, {.how = how});
    CHECK(whole[std::size_t(18) * width + 32].x == Approx(encoded(0.8)).margin(1.5));
    CHECK(whole[0].x == Approx(encoded(0.8 / 4)).margin(4)); // its centre is not quite the corner
    const auto part =
        developed(std::vector<glm::vec3>(16 * 18, glm::vec3(0.8f)), 16, {.how = how, .window = {0.25f, 0.5f, 0.5f, 1}});
    for (std::size_t y = 0; y < 18; ++y)
        for (std::size_t x = 0; x < 16; ++x)
            CHECK(part[y * 16 + x] == whole[(y + 18) * width + x + 16]);
}

TEST_CASE("bloom: light is moved, not added") {
    const auto around = point(128, 61, 66);
    const auto out = view::bloomed(around, 128, 128, 0.2f);
    CHECK(sum(out).x == Approx(sum(around).x).epsilon(0.01));
    CHECK(sum(out).y == Approx(sum(around).y).epsilon(0.01));
    CHECK(sum(out).z == 0);
    const auto at = [&](std::uint32_t x, std::uint32_t y) { return out[std::size_t(y) * 128 + x].x; };
    CHECK(at(61, 66) > 800);
    // About a quarter at twice the distance, and alike in all directions.
    for (const std::uint32_t r : {4u, 8u, 16u}) {
        CHECK(at(61 + r, 66) / at(61 + 2 * r, 66) > 2.5);
        CHECK(at(61 + r, 66) / at(61 + 2 * r, 66) < 6.5);
        CHECK(at(61 + r, 66) / at(61, 66 - r) == Approx(1).margin(0.3));
        CHECK(at(61 + r, 66) / at(61 - r, 66) == Approx(1).margin(0.3));
    }
    // As if the picture went on beyond its edges, which of odd sizes counts lights there more than once.
    for (const std::uint32_t side : {37u, 64u, 129u}) {
        const auto grey = std::vector<glm::vec3>(std::size_t(side) * side, glm::vec3(0.3f, 2, 0));
        for (const glm::vec3& c : view::bloomed(grey, side, side, 0.5f)) {
            CHECK(c.x == Approx(0.3f).epsilon(1e-5));
            CHECK(c.y == Approx(2).epsilon(1e-5));
        }
        const auto corner = point(side, 0, side - 1);
        CHECK(sum(view::bloomed(corner, side, side, 0.3f)).x < 1.6 * sum(corner).x);
    }
    CHECK(view::bloomed(around, 128, 128, 0) == around);
    const auto tiny = std::vector<glm::vec3>{glm::vec3(1), glm::vec3(2)};
    CHECK(view::bloomed(tiny, 2, 1, 1) == tiny);
}

TEST_CASE("a development is applied to .png and .jpg, not to .exr") {
    const test::TemporaryFolder folder;
    view::Picture picture{.film = render::FilmImage::blank(16, 8), .denoised = {}, .exposure = 2};
    std::ranges::fill(picture.film.color, glm::vec3(0.09f));
    const auto pixel = [&](const char* name, const view::PictureOptions& options = {}) {
        const std::string path = (folder.path() / name).string();
        REQUIRE(view::write_picture(path, picture, options));
        const auto read = io::read_image(path, scene::Encoding::srgb);
        REQUIRE(read);
        return encoded(double(read->values[0]));
    };
    CHECK(pixel("plain.png") == Approx(encoded(0.18)).margin(0.6));
    picture.development.tone = ToneCurve::agx;
    const double grey = encoded(std::pow(0.5, 2.2));
    CHECK(pixel("agx.png") == Approx(grey).margin(1.1));
    CHECK(pixel("agx.jpg") == Approx(grey).margin(2));
    CHECK(pixel("bright.png", {.exposure_stops = 1}) > grey + 10);
    CHECK(pixel("agx.exr") == Approx(encoded(0.18)).margin(0.1));
    CHECK(pixel("agx.pfm") == Approx(encoded(0.18)).margin(0.1));
}

TEST_CASE("false colours of the exposure: whole stops, and what is cut off") {
    render::FilmImage image = render::FilmImage::blank(5, 1);
    image.color = {glm::vec3(0), glm::vec3(0.18f), glm::vec3(0.18f / 4), glm::vec3(3, 0.1f, 0.1f),
                   glm::vec3(0.18f * 2.5f)};
    std::vector<std::uint32_t> rgba;
    const auto zone = [&](std::size_t i) -> std::string_view {
        for (const view::ExposureZone& z : view::exposure_zones())
            if (z.color == rgba[i]) return z.label;
        return "none";
    };
    const auto show = [&](const view::DisplaySettings& settings) { view::to_display(image, settings, rgba); };
    show({.layer = view::exposure_layer});
    CHECK((zone(0) == "Black" && zone(1) == "0" && zone(2) == "-2" && zone(3) == "White" && zone(4) == "+1"));
    show({.layer = view::exposure_layer, .exposure = -3, .scale = 2}); // two stops less
    CHECK((zone(1) == "-2" && zone(2) == "-4" && zone(4) == "-1"));
    CHECK(zone(3) != "White");
    show({.layer = view::exposure_layer, .exposure = 4});
    CHECK(zone(1) == "White");
    show({.layer = view::exposure_layer, .exposure = 4, .development = {.tone = ToneCurve::agx}});
    CHECK(zone(1) == "+4"); // AgX still shows it
}

// SPDX-License-Identifier: Apache-2.0
// Blurred skies: what stays, how wide a point becomes, and the edit.
#include "scene/sky_blur.hpp"

#include "scene/edits.hpp"
#include "scene/history.hpp"
#include "shared/octahedral.h"

#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <numbers>

using namespace restage;
using namespace restage::scene;

namespace {

constexpr double pi = std::numbers::pi;

PixelData panorama(std::uint32_t height, glm::vec3 color) {
    PixelData pixels{.width = 2 * height, .height = height, .channels = 3, .values = {}};
    for (std::uint32_t i = 0; i < 2 * height * height; ++i)
        pixels.values.insert(pixels.values.end(), {color.x, color.y, color.z});
    return pixels;
}

double mean_of_map(const PixelData& map, int channel) { // octahedral: of equal areas
    double sum = 0;
    for (std::size_t i = std::size_t(channel); i < map.values.size(); i += 3)
        sum += double(map.values[i]);
    return sum / (double(map.width) * map.height);
}

} // namespace

TEST_CASE("a constant sky stays as it is", "[sky]") {
    for (const double degrees : {3.0, 20.0, 90.0}) {
        const PixelData map = blurred_sky(panorama(16, {0.5f, 2, 7}), Mapping::equirect, degrees);
        CHECK(map.width == map.height);
        for (std::size_t i = 0; i < map.values.size(); i += 3)
            CHECK((std::abs(map.values[i] - 0.5f) < 1e-5 && std::abs(map.values[i + 2] - 7) < 1e-4));
    }
}

TEST_CASE("a sun keeps its light and its place, and becomes as wide as asked for", "[sky]") {
    for (const double row : {0.5, 30.5, 63.5}) // near the zenith; high; at the horizon
        for (const double degrees : {4.0, 12.0}) {
            PixelData pixels = panorama(128, glm::vec3(0));
            const std::size_t x = 3; // beside the seam
            pixels.values[3 * (std::size_t(row) * 256 + x)] = 50000;
            const double theta = pi * (std::floor(row) + 0.5) / 128, phi = 2 * pi * (x + 0.5) / 256;
            const double low = pi * std::floor(row) / 128, high = low + pi / 128;
            const double power = 50000 * 2 * pi / 256 * (std::cos(low) - std::cos(high)); // W/m^2, facing it
            const PixelData map = blurred_sky(pixels, Mapping::equirect, degrees);
            CHECK(std::abs(mean_of_map(map, 0) * 4 * pi - power) < 1e-4 * power);
            CHECK(mean_of_map(map, 1) == 0);
            glm::dvec3 centre(0);
            for (std::size_t i = 0; i < map.values.size() / 3; ++i)
                centre +=
                    double(map.values[3 * i]) *
                    glm::dvec3(shared::octahedral_to_direction(
                        glm::dvec2(double(i % map.width) + 0.5, double(i / map.width) + 0.5) / double(map.width)));
            centre /= double(map.values.size() / 3) * mean_of_map(map, 0);
            const glm::dvec3 sun(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
            INFO("row " << row << ", " << degrees << " degrees");
            CHECK(glm::degrees(std::acos(std::min(glm::dot(glm::normalize(centre), sun), 1.0))) < 0.1 * degrees);
            // The mean of the cosine, of the von Mises-Fisher distribution: coth k - 1 / k with k = 1 / s^2.
            const double s = glm::radians(degrees);
            CHECK(std::abs((1 - glm::length(centre)) / (s * s) - 1) < 0.1);
        }
}

TEST_CASE("what is no light counts as none, in grey images, too", "[sky]") {
    PixelData pixels{.width = 2, .height = 1, .channels = 1, .values = {std::nanf(""), -3}};
    for (const float v : blurred_sky(pixels, Mapping::equirect, 30).values)
        CHECK(v == 0);
    pixels.values = {1, 3};
    const PixelData map = blurred_sky(pixels, Mapping::equirect, 10);
    CHECK(std::abs(mean_of_map(map, 2) - 2) < 1e-5);
}

TEST_CASE("a sky is blurred by one edit, which undo takes back", "[sky]") {
    Scene s;
    History history;
    CHECK_FALSE(blur_sky(s, 10));
    const auto id = s.images.next();
    apply(s,
          insert(s, Image{.name = "noon", .data = std::make_shared<const PixelData>(panorama(8, glm::vec3(1)))}, ""));
    Environment sky{.image = id, .scale = glm::vec3(3)};
    apply(s, set_environment(s, sky));
    CHECK_FALSE(blur_sky(s, 0));
    CHECK_FALSE(blur_sky(s, std::nan("")));
    const auto edit = blur_sky(s, 10);
    REQUIRE(edit);
    history.push(s, *edit);
    CHECK(history.undo_label() == "Blur sky");
    const Environment& now = *s.environment.value;
    CHECK(now.mapping == Mapping::octahedral);
    CHECK(now.scale == glm::vec3(3));
    CHECK(s.images[now.image].name == "noon blurred");
    CHECK(s.images[now.image].path.empty());
    history.undo(s);
    CHECK(*s.environment.value == sky);
}

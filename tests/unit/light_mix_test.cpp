// SPDX-License-Identifier: Apache-2.0
// Sums of lights' pictures, and the light of a spot.
#include "view/light_mixer.hpp"

#include <catch2/catch_test_macros.hpp>
#include <cmath>

using namespace restage;
using view::LightPicture, view::LightPictures;

namespace {

// A grey and a red light, 16 x 8 pixels; the red one reaches the right half alone.
LightPictures two_lights() {
    LightPictures pictures;
    for (int k = 0; k < 2; ++k) {
        auto picture = std::make_shared<LightPicture>();
        picture->film = render::FilmImage::blank(16, 8);
        picture->film.samples = k == 0 ? 8 : 4;
        for (std::size_t i = 0; i < picture->film.pixels(); ++i) {
            picture->film.color[i] = k == 0 ? glm::vec3(1) : glm::vec3(i % 16 >= 8 ? 2 : 0, 0, 0);
            picture->film.std_error[i] = glm::vec3(1);
        }
        picture->clean = picture->film.color;
        if (k == 0) picture->clean.front() = glm::vec3(3);
        pictures.layers.push_back(std::move(picture));
    }
    return pictures;
}

} // namespace

TEST_CASE("light mix: pictures are added by their weights, per channel") {
    LightPictures pictures = two_lights();
    CHECK((pictures.complete() && pictures.samples() == 4));
    const glm::vec3 weights[] = {{1, 2, 3}, glm::vec3(0.5f)};
    const render::FilmImage mixed = view::mix(pictures, weights, false);
    CHECK(mixed.samples == 4);
    CHECK((mixed.color.front() == glm::vec3(1, 2, 3)));
    CHECK((mixed.color.back() == glm::vec3(2, 2, 3)));
    CHECK((mixed.std_error.front() == glm::vec3(0))); // not known
    CHECK((view::mix(pictures, weights, true).color.front() == glm::vec3(3, 6, 9)));
    pictures.layers.push_back(nullptr);
    CHECK_FALSE(pictures.complete());
    CHECK(pictures.samples() == 0);
}

TEST_CASE("light mix: how much each light brings to a spot, and what makes it brighter") {
    const LightPictures pictures = two_lights();
    const glm::vec3 weights[] = {glm::vec3(1), glm::vec3(1)};
    const auto right = view::light_at(pictures, weights, {0.9, 0.5});
    CHECK(std::abs(right[0] - 1) < 1e-6);
    CHECK(std::abs(right[1] - 2 * 0.2126) < 1e-3);
    const auto left = view::light_at(pictures, weights, {0.2, 1.0}); // at the picture's edge
    CHECK(left[1] == 0);
    CHECK_FALSE(view::brightening(left, 1, 2)); // it does not reach the spot
    for (const std::size_t layer : {0u, 1u}) {
        const auto by = view::brightening(right, layer, 2);
        REQUIRE(by);
        glm::vec3 changed[] = {weights[0], weights[1]};
        changed[layer] *= float(*by);
        const auto now = view::light_at(pictures, changed, {0.9, 0.5});
        CHECK(std::abs((now[0] + now[1]) / (right[0] + right[1]) - 2) < 1e-5);
    }
    CHECK(view::brightening(right, 1, 0.5) == 0); // the other one alone is brighter than that
}

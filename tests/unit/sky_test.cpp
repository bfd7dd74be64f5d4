// SPDX-License-Identifier: Apache-2.0
// Skies set by the editor: the up axis, values kept from the previous sky, and that an image is added once.
#include "scene/sky.hpp"
#include "scene/edits.hpp"
#include "scene/history.hpp"
#include "scene/studio.hpp"

#include <catch2/catch_test_macros.hpp>

using namespace restage;
using namespace restage::scene;

namespace {

std::shared_ptr<const PixelData> pixels(std::uint32_t width, std::uint32_t height) {
    return std::make_shared<const PixelData>(PixelData{
        .width = width, .height = height, .channels = 3, .values = std::vector<float>(3 * width * height, 1.f)});
}

} // namespace

TEST_CASE("a sky's pole points up, and its frame is a rotation", "[sky]") {
    for (const glm::dvec3& up : {glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0)}) {
        const glm::dmat3 m(scene::upright_sky(up));
        CHECK(glm::length(m * glm::dvec3(0, 0, 1) - up) < 1e-12);
        CHECK(std::abs(glm::determinant(m) - 1) < 1e-12);
    }
}

TEST_CASE("an image as sky keeps an image's rotation and strength, not a plain sky's colour", "[sky]") {
    Scene s;
    History history;
    history.push(s, set_environment(s, Environment{.scale = glm::vec3(0.2f, 0.3f, 0.9f)}));
    history.push(s, scene::image_sky(s, "/skies/noon.png", pixels(4, 2), {0, 1, 0}));
    REQUIRE(s.environment.value);
    CHECK(s.environment.value->scale == glm::vec3(1));
    CHECK(s.environment.value->mapping == scene::Mapping::equirect);
    CHECK(s.images[s.environment.value->image].encoding == scene::Encoding::srgb); // 8-bit panoramas are encoded

    Environment turned = *s.environment.value;
    turned.scale = glm::vec3(3);
    turned.light_to_world = scene::upright_sky({1, 0, 0});
    history.push(s, set_environment(s, turned));
    history.push(s, scene::image_sky(s, "/skies/dusk.exr", pixels(8, 4), {0, 1, 0}));
    CHECK(s.environment.value->scale == glm::vec3(3));
    CHECK(s.environment.value->light_to_world == turned.light_to_world);
    CHECK(s.images.live() == 2);

    history.push(s, scene::image_sky(s, "/skies/noon.png", pixels(4, 2), {0, 1, 0})); // again
    CHECK(s.images.live() == 2);
    history.push(s, scene::image_sky(s, "/skies/square.exr", pixels(4, 4), {0, 1, 0}));
    CHECK(s.environment.value->mapping == scene::Mapping::octahedral);
    CHECK(s.environment.value->light_to_world ==
          scene::upright_sky({0, 1, 0})); // a different mapping: the rotation is not kept
}

TEST_CASE("a new document has a studio that lights it from above", "[sky]") {
    const Scene s = scene::studio_scene();
    REQUIRE(s.environment.value);
    const Image& image = s.images[s.environment.value->image];
    const auto row = [&](std::uint32_t y) { return image.data->values[3 * std::size_t(y) * image.data->width]; };
    CHECK(row(0) > 2 * row(image.data->height - 1));
    CHECK(glm::length(glm::dmat3(s.environment.value->light_to_world) * glm::dvec3(0, 0, 1) - glm::dvec3(0, 1, 0)) <
          1e-12);
}

// SPDX-License-Identifier: Apache-2.0
// The renderer follows a scene: an edit changes only what it touches, and a new scene keeps nothing of the old one.
#include "render/fixture.hpp"
#include "render/scene_builder.hpp"

#include <catch2/generators/catch_generators.hpp>

using namespace restage;
using namespace restage::tests;

namespace {

// Balls in a row over a floor, under a sky.
SceneBuilder balls(int count) {
    SceneBuilder b;
    b.set_camera({0, -9, 3}, {0, 0, 0.6}, {0, 0, 1}, 35);
    b.instance(b.quad({-8, -8, 0}, {8, -8, 0}, {8, 8, 0}, {-8, 8, 0}), b.diffuse(0.6f, 0.6f, 0.5f));
    const auto ball = b.sphere(12, 24);
    for (int i = 0; i < count; ++i) {
        glm::dmat4 m(0.7);
        m[3] = {1.6 * i - 0.8 * (count - 1), 0, 0.7, 1};
        b.instance(ball, b.diffuse(0.2f, 0.5f, 0.7f), m);
    }
    b.environment(glm::vec3(1, 1.1f, 1.3f));
    return b;
}

void check_equal(const render::FilmImage& a, const render::FilmImage& b) {
    REQUIRE(a.color.size() == b.color.size());
    double worst = 0;
    for (std::size_t i = 0; i < a.color.size(); ++i)
        worst = std::max(worst, double(glm::length(a.color[i] - b.color[i])));
    CHECK(worst < 1e-5);
}

} // namespace

TEST_CASE("a new scene keeps nothing of the old one") {
    const auto tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    const auto many = balls(4), few = balls(1);
    const auto before = render_image(*renderer, many.scene, 4);
    renderer->forget_scene();
    const auto after = render_image(*renderer, few.scene, 4);
    check_equal(after, render_image(*make_renderer(tracer), few.scene, 4));
    renderer->forget_scene();
    check_equal(before, render_image(*renderer, many.scene, 4));
}

TEST_CASE("an edited scene renders like the same scene built from scratch") {
    const auto tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    auto b = balls(3);
    auto& scene = b.scene;
    render_image(*renderer, scene, 1);
    const auto first = scene.instances.size() - 2; // of the balls
    const auto edit = [&](std::uint32_t value, auto&& change) {
        const scene::Id<scene::Instance> id{std::uint32_t(value)};
        auto instance = scene.instances[id];
        change(instance);
        scene.instances.set(id, instance, ++scene.clock);
    };
    const auto check = [&] {
        const auto image = render_image(*renderer, scene, 4);
        check_equal(image, render_image(*make_renderer(tracer), scene, 4));
    };
    edit(first, [](auto& i) { i.object_to_world[3].z += 0.5; }); // moved
    check();
    edit(first + 1, [](auto& i) { i.hidden = true; });
    check();
    const auto copy = scene.instances[scene::Id<scene::Instance>{std::uint32_t(first)}];
    const auto id = scene.instances.next();
    scene.instances.set(id, copy, ++scene.clock); // duplicated
    edit(id.value, [&](auto& i) {
        i.object_to_world[3].x += 1.2;
        i.material = b.material("mirror"); // a new type
    });
    check();
    edit(first + 2, [&](auto& i) { i.alpha = 0.5f; }); // now cut out
    check();
    scene.instances.set(id, std::nullopt, ++scene.clock); // deleted
    check();
    edit(first + 1, [](auto& i) { i.hidden = false; });
    check();
}

TEST_CASE("a stop is heeded between the bounces of a sample, which then leaves nothing behind") {
    const auto scene = balls(2).scene;
    const auto renderer = make_renderer("embree");
    REQUIRE(renderer->sync(scene));
    REQUIRE(renderer->trace(1, {})); // all kernels are there
    for (const int bounce : {1, 2, 3, 4}) {
        int asked = 0;
        REQUIRE(renderer->trace(1, [&] { return ++asked < bounce; }));
        CHECK(asked == bounce);
        CHECK(renderer->samples() == 1);
    }
    REQUIRE(renderer->trace(3, {}));
    check_equal(renderer->image(), render_image(*make_renderer("embree"), scene, 4));
}

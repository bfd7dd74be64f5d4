// SPDX-License-Identifier: Apache-2.0
// Light mixer: the weighted sum of pictures of single lights is the picture of all of them.
#include "view/light_mixer.hpp"

#include "render/checks.hpp"
#include "scene/edit.hpp"

#include <catch2/generators/catch_generators.hpp>
#include <chrono>
#include <thread>

using namespace restage;
using namespace restage::tests;
using view::LightMixer, view::LightPictures;

namespace {

// A box on a coloured floor, under a sky, a point light and two lamps. What is tinted is reflected as such.
struct Stage : SceneBuilder {
    explicit Stage(bool catcher = false) {
        set_film(24, 16);
        set_camera({0, -6, 4}, {0, 0, 0.5}, {0, 0, 1}, 40);
        const auto floor = instance(quad({-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}), diffuse(0.8f, 0.5f, 0.3f));
        edit_instance(*this, floor, [&](scene::Instance& i) { i.catcher = catcher; });
        instance(cube(*this), diffuse(0.3f, 0.6f, 0.7f), placed({0, 0, 0.7}, 0.7));
        const auto lamp = quad({-0.5f, -0.5f, 3}, {-0.5f, 0.5f, 3}, {0.5f, 0.5f, 3}, {0.5f, -0.5f, 3});
        instance(lamp, diffuse(0, 0, 0), placed({-2, 0, 0}), scene::Emission{.radiance = {6, 5, 4}});
        instance(lamp, diffuse(0, 0, 0), placed({2, 1, 0}), scene::Emission{.radiance = {2, 3, 9}});
        light({.name = "point", .value = glm::vec3(8), .light_to_world = placed({1, -3, 3})});
        environment({0.1f, 0.15f, 0.3f});
    }
};

render::RendererOptions options() {
    return {.tracer = "embree", .shader_dir = restage::test::source_dir() / "shaders"};
}

std::shared_ptr<const LightPictures> mixed(LightMixer& mixer, const Stage& stage, std::uint32_t samples) {
    mixer.start({plugins().registry, plugins().log, options()},
                {.scene = stage.scene,
                 .layers = view::light_layers(stage.scene, plugins().registry, 8),
                 .size = {24, 16},
                 .samples = samples,
                 .denoise = false});
    for (int i = 0; i < 80000 && !mixer.done(); ++i) // ctest's limit comes first
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    return mixer.pictures();
}

// Of means of the whole picture and of its quarters, per channel, in standard errors of independent pixels.
double largest_z(const LightPictures& layers, std::span<const glm::vec3> weights, const render::FilmImage& whole) {
    const render::FilmImage sum = view::mix(layers, weights, false);
    double largest = 0;
    for (int part = 0; part < 5; ++part)
        for (int c = 0; c < 3; ++c) {
            double difference = 0, variance = 0;
            for (std::size_t i = 0; i < whole.pixels(); ++i) {
                const bool right = i % whole.width >= whole.width / 2, low = i / whole.width >= whole.height / 2;
                if (part < 4 && part != (right ? 1 : 0) + (low ? 2 : 0)) continue;
                difference += double(sum.color[i][c]) - double(whole.color[i][c]);
                variance += std::pow(double(whole.sample_error[i][c]), 2);
                for (std::size_t k = 0; k < layers.layers.size(); ++k)
                    variance += std::pow(double(weights[k][c]) * double(layers.layers[k]->film.sample_error[i][c]), 2);
            }
            largest = std::max(largest, std::abs(difference) / std::sqrt(variance));
        }
    return largest;
}

} // namespace

TEST_CASE("light mixer: the sum of all lights' pictures is the picture of the scene, also of other strengths") {
    Stage stage(GENERATE(false, true));
    LightMixer mixer([] {});
    const auto layers = mixed(mixer, stage, 256);
    REQUIRE(layers);
    REQUIRE(layers->layers.size() == 4);
    CHECK(layers->samples() == 256);
    auto renderer = make_renderer("embree", {.seed = 77});
    const auto equal = [&](std::span<const glm::vec3> weights) {
        renderer->forget_scene();
        return largest_z(*layers, weights, render_image(*renderer, stage.scene, 256));
    };
    const std::vector<glm::vec3> one(4, glm::vec3(1));
    CHECK(equal(one) < 4); // of 15 numbers
    const std::vector<glm::vec3> weights{{2, 1, 0.5f}, glm::vec3(0.25f), {0.2f, 1, 1}, glm::vec3(3)};
    const double before = equal(weights);
    INFO("before the weights are applied z = " << before);
    CHECK(before > 20);
    const auto edit = view::weigh_lights(stage.scene, plugins().registry,
                                         view::light_layers(stage.scene, plugins().registry, 8), weights);
    REQUIRE(edit);
    scene::apply(stage.scene, *edit);
    CHECK(equal(weights) < 4);
}

TEST_CASE("light mixer: pictures depend on the numbers of samples alone, not on pauses") {
    const Stage stage;
    LightMixer steady([] {}), paused([] {});
    const auto expected = mixed(steady, stage, 16);
    std::thread other([&] {
        for (int i = 0; i < 200; ++i) {
            paused.pause(i % 2 == 0);
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        paused.pause(false);
    });
    const auto now = mixed(paused, stage, 16);
    other.join();
    REQUIRE((expected && now));
    for (std::size_t k = 0; k < expected->layers.size(); ++k)
        CHECK((expected->layers[k]->film.color == now->layers[k]->film.color));
    // A layer's picture is that of its light alone.
    auto renderer = make_renderer("embree", {.seed = 1});
    scene::Scene alone = stage.scene;
    alone.environment = {std::nullopt, ++alone.clock};
    alone.instances.each([&](auto id, scene::Instance lamp) {
        if (lamp.emission) lamp.hidden = true, alone.instances.set(id, lamp, ++alone.clock);
    });
    check_same_mean(render_image(*renderer, alone, 64), expected->layers[1]->film);
}

TEST_CASE("light mixer: a stopped job leaves nothing, and the next begins anew") {
    Stage stage;
    LightMixer mixer([] {});
    REQUIRE(mixed(mixer, stage, 2));
    mixer.stop();
    CHECK_FALSE(mixer.pictures());
    stage.environment(glm::vec3(0));
    const auto layers = mixed(mixer, stage, 2);
    REQUIRE(layers);
    CHECK(layers->layers.size() == 3); // the sky is dark
}

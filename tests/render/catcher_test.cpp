// SPDX-License-Identifier: Apache-2.0
// Shadow catchers: closed forms of the light that objects keep from them, and what other rays see of them.
#include "render/catcher.hpp"
#include "render/agreement.hpp"
#include "render/checks.hpp"
#include "render/film_error.hpp"
#include "view/merge_pictures.hpp"

#include <array>
#include <catch2/generators/catch_generators.hpp>
#include <cmath>
#include <numbers>

using namespace restage;
using namespace restage::tests;

namespace {

constexpr float sky = 0.75f;
constexpr double blocker_half = 1, blocker_height = 1.5;

scene::Id<scene::Instance> catcher(SceneBuilder& b) {
    const auto floor = ground(b, 0.2f); // the albedo does not count
    edit_instance(b, floor, [](scene::Instance& i) { i.catcher = true; });
    return floor;
}

// A black square above the origin of a catcher, which the camera sees from below the square.
void blocker(SceneBuilder& b) {
    const auto s = float(blocker_half), z = float(blocker_height);
    b.instance(b.quad({-s, -s, z}, {s, -s, z}, {s, s, z}, {-s, s, z}), b.diffuse(0, 0, 0));
}

// Of what a horizontal surface at the origin receives from a uniform sky, the part that comes through the blocker: four
// times the form factor of a rectangle to a point below its corner, parallel (Howell, "A Catalog of Radiation Heat
// Transfer Configuration Factors", B-3).
double blocked() {
    const double a = blocker_half / blocker_height, root = std::sqrt(1 + a * a);
    return 4 / (2 * std::numbers::pi) * 2 * (a / root * std::atan(a / root));
}

SceneBuilder under_blocker() {
    SceneBuilder b;
    look_down(b, {0, 0, 1});
    b.environment(glm::vec3(sky));
    catcher(b);
    blocker(b);
    return b;
}

void hide_sky(SceneBuilder& b) {
    auto environment = *b.scene.environment.value;
    environment.hidden_from_camera = true;
    b.scene.environment = {environment, ++b.scene.clock};
}

double mean(const std::vector<float>& values) {
    double sum = 0;
    for (const float v : values)
        sum += v;
    return sum / double(values.size());
}

} // namespace

TEST_CASE("catcher: a square keeps its form factor of a uniform sky") {
    const auto renderer = make_renderer(GENERATE("embree", "vulkan"));
    SceneBuilder b = under_blocker();
    const auto image = render_image(*renderer, b.scene, 256);
    REQUIRE(render::has_catchers(image));
    const Mean m = mean_luminance(image);
    INFO("mean " << m.value << " +- " << m.std_error << ", expected " << sky * (1 - blocked()));
    CHECK(std::abs(m.value - sky * (1 - blocked())) < 3 * m.std_error + 1e-4);
    CHECK(m.std_error < 0.01);
    CHECK(std::abs(mean(image.alpha) - blocked()) < 3 * m.std_error / sky + 1e-4);

    hide_sky(b); // before nothing: black with the alpha of the shadow
    const auto black = render_image(*renderer, b.scene, 256);
    CHECK(mean_luminance(black).value == 0);
    CHECK(std::abs(mean(black.alpha) - blocked()) < 3 * m.std_error / sky + 1e-4);
    CHECK(mean(black.coverage) == 1);
}

TEST_CASE("catcher: a sun's shadow leaves the sky's part of the light") {
    const auto renderer = make_renderer(GENERATE("embree", "vulkan"));
    SceneBuilder b = under_blocker();
    glm::dmat4 down(1); // light goes along -z there: towards the catcher
    down[2] = {0, 0, -1, 0};
    down[0] = {-1, 0, 0, 0};
    const double sun = 3; // irradiance
    b.light({.kind = scene::LightKind::distant, .value = glm::vec3(float(sun)), .light_to_world = down});
    const auto image = render_image(*renderer, b.scene, 1024);
    const double with = std::numbers::pi * sky * (1 - blocked()), expected = with / (std::numbers::pi * sky + sun);
    const Mean m = mean_luminance(image);
    INFO("ratio " << m.value / sky << ", expected " << expected);
    CHECK(std::abs(m.value / sky - expected) < 0.01 * expected);
}

TEST_CASE("catcher: alone it is not seen, exactly") {
    const auto renderer = make_renderer(GENERATE("embree", "vulkan"));
    SceneBuilder b;
    b.set_film(32, 32);
    b.set_camera({0, -10, 3}, {0, 0, 3}, {0, 0, 1}, 60);
    b.environment(glm::vec3(sky));
    b.light({.kind = scene::LightKind::point, .value = glm::vec3(20)});
    catcher(b);
    const auto image = render_image(*renderer, b.scene, 16);
    REQUIRE(render::has_catchers(image));
    float off = 0, opaque = 0;
    for (std::size_t i = 0; i < image.color.size(); ++i) {
        off = std::max(off, std::abs(image.color[i].y - sky));
        opaque = std::max(opaque, std::abs(image.alpha[i]));
    }
    CHECK(off < 1e-6f * sky);
    CHECK(opaque < 1e-6f);
    CHECK(mean(image.caught) > 0.4);

    edit_instance(b, {1}, [](scene::Instance& i) { i.catcher = false; });
    const auto floor = render_image(*renderer, b.scene, 16);
    CHECK_FALSE(render::has_catchers(floor));
    CHECK(floor.alpha.empty());
    CHECK(mean_luminance(floor).value < 0.9 * sky);
}

TEST_CASE("catcher: mirrors and other surfaces see through it") {
    const auto renderer = make_renderer(GENERATE("embree", "vulkan"));
    SceneBuilder b;
    b.set_film(16, 16);
    b.set_camera({0, -8, 0}, {0, 0, 0}, {0, 0, 1}, 10); // only the ball is seen: its lower half reflects what is below
    b.environment(glm::vec3(sky));
    b.instance(b.sphere(),
               GENERATE(0, 1) == 0 ? b.diffuse(1, 1, 1) : b.material("conductor", numbers({{"roughness", 0}})));
    b.scene.settings.value.max_depth = 32;
    const auto before = render_image(*renderer, b.scene, 16);
    const auto floor =
        b.instance(b.quad({-50, -50, -2}, {50, -50, -2}, {50, 50, -2}, {-50, 50, -2}), b.diffuse(0, 0, 0));
    edit_instance(b, floor, [](scene::Instance& i) { i.catcher = true; });
    const auto after = render_image(*renderer, b.scene, 16);
    CHECK_FALSE(render::has_catchers(after));
    for (std::size_t i = 0; i < after.color.size(); ++i)
        CHECK(std::abs(after.color[i].y - before.color[i].y) < 2e-3f * before.color[i].y);
}

TEST_CASE("catcher: both tracers give the same shadows and reflected light") {
    SceneBuilder b;
    b.set_film(48, 48);
    b.set_camera({0, -9, 4}, {0, 0, 0.5}, {0, 0, 1}, 40);
    b.environment(glm::vec3(sky));
    b.light({.kind = scene::LightKind::point, .value = glm::vec3(10), .light_to_world = placed({3, -2, 4})});
    catcher(b);
    b.instance(b.sphere(), b.diffuse(0.9f, 0.2f, 0.1f), placed({0, 0, 1}));
    const auto vulkan = trace_scene("vulkan", b.scene, 64, 1), embree = trace_scene("embree", b.scene, 64, 2);
    check_independent(vulkan.image, embree.image);
    CHECK(share_alike(vulkan.image, trace_scene("embree", b.scene, 64, 1).image) > 0.95);
    CHECK(std::abs(mean(vulkan.image.alpha) - mean(embree.image.alpha)) < 0.01);
    // Red light from the ball is on the catcher: somewhere it is redder than its backdrop.
    float redder = 0;
    for (std::size_t i = 0; i < embree.image.color.size(); ++i)
        if (embree.image.caught[i] == 1)
            redder = std::max(redder, embree.image.color[i].x / std::max(embree.image.color[i].z, 1e-3f));
    CHECK(redder > 1.02f);
}

TEST_CASE("catcher: merged parts have the shadows of the whole") {
    const auto renderer = make_renderer("embree");
    SceneBuilder b = under_blocker();
    const auto first = render_image(*renderer, b.scene, 16);
    REQUIRE(renderer->trace(16));
    const auto whole = renderer->image();
    renderer->restart(0, 16);
    const auto rest = render_image(*renderer, b.scene, 16);
    const std::array parts{view::PicturePart{.film = &first, .first_sample = 0},
                           view::PicturePart{.film = &rest, .first_sample = 16}};
    const auto merged = view::merge_films(parts);
    REQUIRE(merged);
    for (std::size_t i = 0; i < whole.color.size(); ++i) {
        CHECK(std::abs(merged->color[i].y - whole.color[i].y) < 1e-5f);
        CHECK(std::abs(merged->alpha[i] - whole.alpha[i]) < 1e-5f);
    }
}

TEST_CASE("catcher: standard errors are those of the picture") {
    SceneBuilder b;
    b.set_film(48, 48);
    b.set_camera({0, -9, 4}, {0, 0, 0.5}, {0, 0, 1}, 40);
    b.environment(glm::vec3(0.02f)); // the catcher would be much brighter than what is behind it
    b.light({.kind = scene::LightKind::point, .value = glm::vec3(60), .light_to_world = placed({3, -2, 4})});
    catcher(b);
    b.instance(b.sphere(), b.diffuse(0.9f, 0.2f, 0.1f), placed({0, 0, 1}));
    const auto a = trace_scene("embree", b.scene, 64, 1).image, c = trace_scene("embree", b.scene, 64, 2).image;
    double squares = 0, count = 0;
    for (std::size_t i = 0; i < a.pixels(); ++i) {
        const double variance = double(a.luminance_variance[i]) + double(c.luminance_variance[i]);
        if (a.caught[i] < 1 || c.caught[i] < 1 || !(variance > 0)) continue;
        squares += std::pow(render::luminance(a.color[i]) - render::luminance(c.color[i]), 2) / variance;
        ++count;
    }
    INFO("mean of z^2 " << squares / count << " over " << count);
    REQUIRE(count > 100);
    CHECK(squares / count > 0.3);
    CHECK(squares / count < 3);
}

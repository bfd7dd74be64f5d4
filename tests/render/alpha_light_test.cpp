// SPDX-License-Identifier: Apache-2.0
// Lamps with partly missing surfaces: emission and visibility differ. Closed forms, on both tracers.
#include "render/agreement.hpp"
#include "render/checks.hpp"

#include <catch2/generators/catch_generators.hpp>

using namespace restage;
using namespace restage::tests;

namespace {

// A floor of albedo 1/2, a lamp of 1 x 1 and radiance 10 at height 10, the camera in between: it sees only the floor.
struct Floor : SceneBuilder {
    scene::Id<scene::Instance> lamp;
    explicit Floor(float fov = 4) {
        set_film(16, 16);
        set_camera({0, 0, 5}, {0, 0, 0}, {0, 1, 0}, fov);
        instance(quad({-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}), diffuse(0.5f, 0.5f, 0.5f));
        glm::dmat4 up(1);
        up[3].z = 10;
        lamp = instance(quad({-.5f, -.5f, 0}, {-.5f, .5f, 0}, {.5f, .5f, 0}, {.5f, -.5f, 0}), diffuse(0, 0, 0), up,
                        scene::Emission{.radiance = glm::vec3(10)});
        scene.settings.value.max_depth = 1;
    }
    void change(auto&& edit) { edit_instance(*this, lamp, edit); }
    // Alpha 0 for s < 1/2, `rest` beyond.
    void half_hole(float rest) {
        const auto id = scene.textures.next();
        scene::Texture t{.name = "halves", .type = "checkerboard", .is_float = true};
        t.params = numbers({{"uscale", 2.f}, {"vscale", 1.f}, {"tex1", 0.f}, {"tex2", rest}});
        scene.textures.set(id, std::move(t), ++scene.clock);
        change([&](scene::Instance& i) { i.alpha_texture = id; });
    }
};

// Radiance of the floor below the middle of a square of side 1 at height 10: rho/pi L F, with the form factor of four
// quarters (Howell, configuration B-3).
double below_square() {
    const double x = 0.05, s = std::sqrt(1 + x * x);
    const double form = 4 / (2 * std::numbers::pi) * 2 * (x / s * std::atan(x / s));
    return 0.5 * 10 * form;
}

void check_radiance(const render::FilmImage& image, double expected, double widest_error) {
    const Mean m = mean_luminance(image);
    INFO(m.value << " +- " << m.std_error << ", expected " << expected);
    CHECK(std::abs(m.value - expected) < 4 * m.std_error + 0.002 * expected); // the floor is seen 0.18 wide
    CHECK(m.std_error < widest_error * expected);
}

} // namespace

TEST_CASE("a lamp of alpha below 1 is sampled like any other, and emits that fraction") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    for (const float alpha : {1.f, 0.5f, 0.1f}) {
        Floor b;
        b.change([&](scene::Instance& i) { i.alpha = alpha; });
        renderer->forget_scene();
        INFO(tracer << ", alpha " << alpha);
        check_radiance(render_image(*renderer, b.scene, 64), alpha * below_square(), 0.003);
    }
    Floor half;
    half.half_hole(0.5f);
    renderer->forget_scene();
    check_radiance(render_image(*renderer, half.scene, 256), 0.25 * below_square(), 0.02);
}

TEST_CASE("a lamp of alpha 0 emits if it is declared to, and is invisible") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    Floor b;
    b.change([](scene::Instance& i) { i.alpha = 0; });
    CHECK(mean_luminance(render_image(*renderer, b.scene, 4)).value == 0);
    b.change([](scene::Instance& i) { i.emission->unseen = true; });
    check_radiance(render_image(*renderer, b.scene, 64), below_square(), 0.003);
    // Holes emit as well; only the rest is visible.
    b.change([](scene::Instance& i) { i.alpha = 1; });
    b.half_hole(1);
    check_radiance(render_image(*renderer, b.scene, 64), below_square(), 0.003);
    b.set_camera({0, 0, 9}, {0, 0, 10}, {0, 1, 0}, 45);
    b.scene.settings.value.max_depth = 0;
    check_radiance(render_image(*renderer, b.scene, 64), 5, 0.1);
    b.change([](scene::Instance& i) { i.alpha_texture = {}, i.alpha = 0; });
    CHECK(mean_luminance(render_image(*renderer, b.scene, 4)).value == 0);
}

TEST_CASE("alpha as a mask is opaque wherever it is above 0") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    Floor b;
    b.change([](scene::Instance& i) {
        i.alpha = 0.01f;
        i.alpha_mask = true;
    });
    check_radiance(render_image(*renderer, b.scene, 64), below_square(), 0.003);
    b.half_hole(0.3f);
    b.set_camera({0, 0, 9}, {0, 0, 10}, {0, 1, 0}, 45);
    b.scene.settings.value.max_depth = 0;
    check_radiance(render_image(*renderer, b.scene, 64), 5, 0.1);
}

TEST_CASE("every strategy gives the same light from a lamp with alpha") {
    const std::string tracer = GENERATE("embree", "vulkan");
    Floor near_lamp(90);
    near_lamp.change([](scene::Instance& i) {
        i.object_to_world[3].z = 0.6;
        i.emission->two_sided = true;
    });
    near_lamp.half_hole(0.6f);
    const auto traced = [&](render::Strategy strategy, std::uint32_t seed) {
        render::RendererOptions options;
        options.strategy = strategy;
        options.seed = seed;
        return render_image(*make_renderer(tracer, options), near_lamp.scene, 256);
    };
    const auto mis = traced(render::Strategy::mis, 1);
    const Mean m = mean_luminance(mis);
    for (const auto strategy : {render::Strategy::light_only, render::Strategy::bsdf_only}) {
        const Mean other = mean_luminance(traced(strategy, 2));
        INFO(tracer << ": " << m.value << " +- " << m.std_error << ", alone " << other.value << " +- "
                    << other.std_error);
        CHECK(m.value > 0.01);
        CHECK(std::abs(m.value - other.value) < 4 * std::hypot(m.std_error, other.std_error));
    }
}

TEST_CASE("a lamp with a null surface emits, is visible, and hides nothing") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    Floor b;
    const auto none = b.material("interface");
    b.change([&](scene::Instance& i) { i.material = none; });
    check_radiance(render_image(*renderer, b.scene, 64), below_square(), 0.003);
    // In front of a sky of 1 its light is added; from behind, only the sky is visible.
    b.environment(glm::vec3(1));
    b.scene.settings.value.max_depth = 0;
    b.set_camera({0, 0, 9.9}, {0, 0, 10}, {0, 1, 0}, 45);
    check_radiance(render_image(*renderer, b.scene, 4), 11, 1e-5);
    b.set_camera({0, 0, 10.1}, {0, 0, 20}, {0, 1, 0}, 45);
    check_radiance(render_image(*renderer, b.scene, 4), 1, 1e-5);
    // It casts no shadow: a floor below it sees all of the sky, and its light.
    b.scene.settings.value.max_depth = 1;
    b.change([](scene::Instance& i) {
        i.object_to_world[3].z = 1;
        i.emission->radiance = glm::vec3(1e-6f);
    });
    b.set_camera({0, 0, 0.5}, {0, 0, 0}, {0, 1, 0}, 20);
    check_radiance(render_image(*renderer, b.scene, 256), 0.5, 0.01);
}

TEST_CASE("both tracers render the same lamps with null surfaces, behind one another and in media") {
    Floor b(60);
    b.scene.settings.value.max_depth = 4;
    b.environment(glm::vec3(0.2f));
    const auto none = b.material("interface");
    const auto medium = b.scene.media.next();
    b.scene.media.set(medium, scene::Medium{.name = "smoke", .sigma_a = glm::vec3(0.7f, 0.4f, 0.2f)}, ++b.scene.clock);
    b.change([&](scene::Instance& i) {
        i.material = none;
        i.object_to_world[3].z = 1.5;
        i.emission = scene::Emission{.radiance = {1, 2, 3}, .two_sided = true};
    });
    glm::dmat4 ball(0.5);
    ball[3] = {0.3, 0.2, 0.8, 1};
    const auto glow = b.instance(b.sphere(16, 32), none, ball, scene::Emission{glm::vec3(0.5f)});
    edit_instance(b, glow, [&](scene::Instance& i) { i.media = scene::MediumInterface{medium, {}}; });
    check_independent(trace_scene("embree", b.scene, 512, 3).image, trace_scene("vulkan", b.scene, 512, 4).image);
}

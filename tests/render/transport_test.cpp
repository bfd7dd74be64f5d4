// SPDX-License-Identifier: Apache-2.0
// Light transport: every strategy has the same mean, depth has pbrt's meaning, spots fall off, media absorb.
#include "render/checks.hpp"

#include <catch2/generators/catch_generators.hpp>

using namespace restage;
using namespace restage::tests;
constexpr double pi = std::numbers::pi;

TEST_CASE("spot light: smooth falloff between its two cones") {
    const auto tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    SceneBuilder b;
    look_down(b);
    ground(b, 0.5f);
    const auto spot = b.scene.lights.next();
    for (const double angle : {0.0, 15.0, 22.0, 27.0, 29.5, 31.0}) {
        b.scene.lights.set(spot,
                           scene::Light{.kind = scene::LightKind::spot,
                                        .value = glm::vec3(20),
                                        .light_to_world = glm::rotate(placed({0, 0, 4}), pi + glm::radians(angle),
                                                                      glm::dvec3(1, 0, 0)),
                                        .cone_angle = 30,
                                        .cone_delta = 10},
                           ++b.scene.clock);
        const double total = std::cos(glm::radians(30.0)), start = std::cos(glm::radians(20.0)); // pbrt 4ed, 12.2.1
        const double x = std::clamp((std::cos(glm::radians(angle)) - total) / (start - total), 0.0, 1.0);
        INFO("angle " << angle);
        check_mean(render_image(*renderer, b.scene, 4), 0.5 / pi * 20 / 16 * x * x * (3 - 2 * x),
                   6e-3); // the patch is 0.06 degrees wide
    }
}

TEST_CASE("max_depth: 0 shows emitters, each step adds a bounce") {
    const auto tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    SceneBuilder b;
    b.set_film(16, 16);
    b.set_camera({0.2, 0.1, 0}, {1, 0.3, 0.2}, {0, 0, 1}, 60);
    b.instance(b.sphere(32, 64, false), b.diffuse(0.5f, 0.5f, 0.5f), glm::dmat4(1),
               scene::Emission{glm::vec3(1), true});
    double expected = 0, term = 1;
    for (std::uint32_t depth = 0; depth < 4; ++depth) {
        expected += term;
        term *= 0.5;
        b.scene.settings.value.max_depth = depth;
        b.scene.settings.version = ++b.scene.clock;
        INFO("max_depth " << depth);
        check_mean(render_image(*renderer, b.scene, 64), expected);
    }
}

TEST_CASE("light sampling, BSDF sampling and both have the same mean, with and without Russian roulette") {
    const auto tracer = GENERATE("embree", "vulkan");
    std::vector<render::FilmImage> images;
    for (const auto strategy : {render::Strategy::mis, render::Strategy::light_only, render::Strategy::bsdf_only}) {
        render::RendererOptions options;
        options.strategy = strategy;
        options.seed = std::uint32_t(images.size());
        const auto renderer = make_renderer(tracer, options);
        for (const bool roulette : {true, false}) {
            SceneBuilder b;
            b.set_film(24, 24);
            b.set_camera({0, -5, 2.2}, {0, 0, 0.6}, {0, 0, 1}, 40);
            b.scene.settings.value.max_depth = 6;
            b.scene.settings.value.russian_roulette = roulette;
            auto metal = numbers({{"uroughness", 0.3f}, {"vroughness", 0.3f}});
            metal.set("remap", scene::Value::choice("none"));
            b.instance(b.quad({-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}), b.material("conductor", metal));
            b.instance(b.sphere(24, 48), b.diffuse(0.6f, 0.6f, 0.6f), placed({-0.6, 0.3, 0.6}, 0.6));
            b.instance(b.quad({0.4f, 1.2f, 0.2f}, {1.8f, 1.2f, 0.2f}, {1.8f, 0.9f, 2}, {0.4f, 0.9f, 2}),
                       b.diffuse(0.2f, 0.2f, 0.2f), glm::dmat4(1), scene::Emission{glm::vec3(3), false});
            b.instance(b.quad({-2, 2, 0.5f}, {-1, 2, 0.5f}, {-1, 2, 2}, {-2, 2, 2}), b.diffuse(0.2f, 0.2f, 0.2f),
                       glm::dmat4(1), scene::Emission{glm::vec3(1, 2, 3), true});
            std::vector<float> sky;
            for (int y = 0; y < 8; ++y)
                for (int x = 0; x < 16; ++x)
                    sky.push_back(x == 4 && y == 2 ? 8.f : 0.2f + 0.05f * float(y));
            b.scene.environment = {scene::Environment{.name = "sky", .image = b.image(16, 8, 1, sky)}, ++b.scene.clock};
            renderer->forget_scene();
            images.push_back(render_image(*renderer, b.scene, 256));
        }
    }
    for (std::size_t i = 1; i < images.size(); ++i) {
        INFO((i / 2 == 0   ? "mis"
              : i / 2 == 1 ? "light sampling"
                           : "BSDF sampling")
             << (i % 2 ? " without roulette" : "") << " against mis");
        check_same_mean(images[i], images[0]);
    }
}

TEST_CASE("media: Beer and Lambert") {
    const auto tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    const glm::vec3 sigma(0.5f, 1, 2);
    const auto check_color = [](const render::FilmImage& image, const glm::dvec3& expected) {
        glm::dvec3 mean(0);
        for (const auto& c : image.color)
            mean += glm::dvec3(c) / double(image.color.size());
        INFO("mean " << mean.x << ' ' << mean.y << ' ' << mean.z << ", expected " << expected.x << ' ' << expected.y
                     << ' ' << expected.z);
        CHECK(glm::length(mean - expected) < 1e-4);
    };
    SECTION("a slab of index 1") {
        SceneBuilder b;
        look_down(b);
        const auto medium = b.scene.media.next();
        b.scene.media.set(medium, scene::Medium{.name = "ink", .sigma_a = sigma}, ++b.scene.clock);
        const auto slab = b.instance(cube(b), b.material("dielectric", numbers({{"eta", 1}})),
                                     glm::scale(glm::dmat4(1), glm::dvec3(2, 2, 0.4)));
        edit_instance(b, slab, [&](auto& i) { i.media = scene::MediumInterface{.interior = medium}; });
        b.environment(glm::vec3(1));
        b.scene.settings.value.russian_roulette = false; // no noise
        check_color(render_image(*renderer, b.scene, 8), glm::exp(-0.8 * glm::dvec3(sigma)));
    }
    SECTION("the camera inside") {
        for (const bool sky : {false, true}) {
            SceneBuilder b;
            look_down(b, {0, 0, 1.5});
            const auto medium = b.scene.media.next();
            b.scene.media.set(medium, scene::Medium{.name = "ink", .sigma_a = sigma}, ++b.scene.clock);
            b.scene.settings.value.camera_medium = medium;
            if (sky)
                b.environment(glm::vec3(1)); // infinitely far behind it
            else
                b.instance(b.quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}), b.diffuse(0, 0, 0), glm::dmat4(1),
                           scene::Emission{glm::vec3(1), true});
            renderer->forget_scene();
            check_color(render_image(*renderer, b.scene, 8), sky ? glm::dvec3(0) : glm::exp(-1.5 * glm::dvec3(sigma)));
        }
    }
}

TEST_CASE("reverse_orientation and mirroring flip the emitting side, two-sided lamps ignore them") {
    const auto tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    SceneBuilder b;
    look_down(b, {8, 0, 10});
    ground(b, 1);
    b.scene.settings.value.max_depth = 1;
    const auto id = b.instance({}, b.diffuse(0, 0, 0));
    for (const bool smooth : {false, true}) // with shading normals the mesh defines the outside
        for (const bool mirrored : {false, true})
            for (const bool reversed : {false, true})
                for (const bool two_sided : {false, true}) {
                    scene::MeshData lamp{.positions = {{-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}},
                                         .triangles = {{0, 1, 2}, {0, 2, 3}}};
                    if (smooth) // against the winding: up
                        lamp.normals.assign(4, glm::vec3(0, 0, 1));
                    edit_instance(b, id, [&, mesh = b.mesh(lamp)](auto& i) {
                        i.mesh = mesh;
                        i.object_to_world = glm::scale(glm::dmat4(1), glm::dvec3(mirrored ? -1 : 1, 1, 1));
                        i.emission = scene::Emission{glm::vec3(2), two_sided};
                        i.reverse_orientation = reversed;
                    });
                    const auto image = render_image(*renderer, b.scene, 64);
                    const bool down = smooth == reversed || two_sided; // normals say up, or the winding says down
                    const double k = 0.5 / std::sqrt(1.25), form = 4 / (2 * pi) * 2 * k * std::atan(k);
                    INFO("smooth " << smooth << ", mirrored " << mirrored << ", reversed " << reversed << ", two-sided "
                                   << two_sided);
                    check_mean(image, down ? 2 * form : 0);
                }
}

TEST_CASE("a low-polygon sphere lit from one side is as bright as a fine one") {
    const auto tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    const auto render = [&](int rows, bool shading_normals) {
        SceneBuilder b;
        b.set_film(32, 32);
        b.set_camera({0, -8, 0}, {0, 0, 0}, {0, 0, 1}, 17);
        b.instance(b.sphere(rows, 2 * rows, shading_normals, true), b.diffuse(0.8f, 0.8f, 0.8f),
                   glm::rotate(glm::dmat4(1), 0.5, glm::dvec3(1, 0.3, 0.7)));
        b.light({.kind = scene::LightKind::distant,
                 .value = glm::vec3(3),
                 .light_to_world = glm::rotate(glm::dmat4(1), 2.0, glm::dvec3(0.5, 1, 0))});
        renderer->forget_scene();
        return mean_luminance(render_image(*renderer, b.scene, 32)).value;
    };
    const double fine = render(96, true), smooth = render(10, true), flat = render(10, false);
    INFO("fine " << fine << ", 10 rows smooth " << smooth << ", flat " << flat);
    CHECK(std::abs(flat / fine - 1) < 0.03);
    CHECK(std::abs(smooth / fine - 1) < 0.03);
}

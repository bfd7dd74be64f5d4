// SPDX-License-Identifier: Apache-2.0
// Borders of media (`interface`): rays of all kinds pass them straight, and the medium between absorbs by closed form.
#include "render/checks.hpp"

#include <catch2/generators/catch_generators.hpp>

using namespace restage;
using namespace restage::tests;
constexpr double pi = std::numbers::pi;

namespace {

const glm::vec3 ink_sigma(0.5f, 1, 2), tea_sigma(1.5f, 0.1f, 0.3f);

scene::Id<scene::Medium> medium(SceneBuilder& b, const glm::vec3& sigma_a) {
    const auto id = b.scene.media.next();
    b.scene.media.set(id, scene::Medium{.name = "medium", .sigma_a = sigma_a}, ++b.scene.clock);
    return id;
}
// A slab [-2,2]^2 x [-half, half] about `at`, filled.
scene::Id<scene::Instance> slab(SceneBuilder& b, scene::Id<scene::Material> material, double half,
                                scene::MediumInterface media, glm::dvec3 at = {0, 0, 0}, double width = 2) {
    const auto id = b.instance(cube(b), material, glm::scale(placed(at), glm::dvec3(width, width, half)));
    edit_instance(b, id, [&](auto& i) { i.media = media; });
    return id;
}
glm::dvec3 mean_color(const render::FilmImage& image) {
    glm::dvec3 mean(0);
    for (const auto& c : image.color)
        mean += glm::dvec3(c) / double(image.color.size());
    return mean;
}
void check_color(const render::FilmImage& image, const glm::dvec3& expected, double tolerance = 2e-4) {
    const glm::dvec3 mean = mean_color(image);
    INFO("mean " << mean.x << ' ' << mean.y << ' ' << mean.z << ", expected " << expected.x << ' ' << expected.y << ' '
                 << expected.z);
    CHECK(glm::length(mean - expected) < tolerance * (1 + glm::length(expected)));
}

} // namespace

TEST_CASE("borders: camera rays through ink, nested and from within") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    const auto scene_of = [](auto&& fill) {
        SceneBuilder b;
        look_down(b);
        b.environment(glm::vec3(1));
        b.scene.settings.value.max_depth = 0; // borders do not count as bounces
        fill(b);
        return std::move(b.scene);
    };
    const glm::dvec3 ink(ink_sigma), tea(tea_sigma);
    int number = 0;
    const auto check = [&](const scene::Scene& scene, const glm::dvec3& depth) {
        if (tracer == "vulkan" && number++ % 2 == 0) return; // its pipelines take seconds per scene on a CPU
        renderer->forget_scene();
        check_color(render_image(*renderer, scene, 4), glm::exp(-depth));
        CHECK(renderer->gpu_scene().features().borders);
    };
    INFO(tracer);
    check(scene_of([](SceneBuilder& b) { slab(b, b.material("interface"), 0.4, {.interior = medium(b, ink_sigma)}); }),
          0.8 * ink);
    check(scene_of([](SceneBuilder& b) { // a ball: 2 across
              const auto ball = b.instance(b.sphere(64, 128), b.material("interface"),
                                           glm::rotate(glm::dmat4(1), 0.3, glm::dvec3(1, 2, 0)));
              edit_instance(b, ball,
                            [&](auto& i) { i.media = scene::MediumInterface{.interior = medium(b, ink_sigma)}; });
          }),
          1.9996 * ink); // a polyhedron's inside
    check(scene_of([](SceneBuilder& b) { // tea in ink, a gap, tea again
              const auto first = medium(b, ink_sigma), second = medium(b, tea_sigma);
              const auto border = b.material("interface");
              slab(b, border, 0.4, {.interior = first});
              slab(b, border, 0.1, {.interior = second, .exterior = first}, {0, 0, 0.1}, 1);
              slab(b, border, 0.3, {.interior = second}, {0, 0, -2});
          }),
          0.6 * ink + 0.8 * tea);
    check(scene_of([](SceneBuilder& b) { // turned inside out
              const auto id = slab(b, b.material("interface"), 0.4, {.exterior = medium(b, ink_sigma)});
              edit_instance(b, id, [](auto& i) { i.reverse_orientation = true; });
          }),
          0.8 * ink);
    check(scene_of([](SceneBuilder& b) { // the camera inside it
              const auto around = medium(b, ink_sigma);
              slab(b, b.material("interface"), 15, {.interior = around}, {0, 0, 24}, 50);
              b.scene.settings.value.camera_medium = around;
          }),
          ink);
}

TEST_CASE("borders: shadow rays are absorbed, not stopped") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    INFO(tracer);
    for (const bool lamp_inside : {false, true}) {
        if (tracer == "vulkan" && !lamp_inside) continue; // its pipelines take seconds per scene on a CPU
        SceneBuilder b;
        look_down(b, {6, 0, 0.2}); // under the slabs
        ground(b, 0.5f);
        b.light({.kind = scene::LightKind::point, .value = glm::vec3(20), .light_to_world = placed({0, 0, 4})});
        slab(b, b.material("interface"), 0.4, {.interior = medium(b, ink_sigma)}, {0, 0, lamp_inside ? 4 : 2});
        slab(b, b.material("interface"), 0.2, {.interior = medium(b, tea_sigma)}, {0, 0, 0.5}); // and another
        renderer->forget_scene();
        check_color(render_image(*renderer, b.scene, 4),
                    0.5 / pi * 20 / 16 *
                        glm::exp(-(lamp_inside ? 0.4 : 0.8) * glm::dvec3(ink_sigma) - 0.4 * glm::dvec3(tea_sigma)),
                    2e-3); // the patch is 0.06 degrees wide
    }
    if (tracer == "vulkan") return;
    SceneBuilder b; // from infinitely far: the slab at 60 degrees
    look_down(b, {0, -10, 1});
    ground(b, 0.5f);
    b.light({.kind = scene::LightKind::distant,
             .value = glm::vec3(2),
             .light_to_world = glm::rotate(glm::dmat4(1), pi + pi / 3, glm::dvec3(0, 1, 0))});
    slab(b, b.material("interface"), 0.4, {.interior = medium(b, ink_sigma)}, {0, 0, 2}, 20);
    renderer->forget_scene();
    // the camera looks under the slab
    check_color(render_image(*renderer, b.scene, 4), 0.5 / pi * 2 * 0.5 * glm::exp(-1.6 * glm::dvec3(ink_sigma)), 2e-3);
}

TEST_CASE("borders: light sampling, BSDF sampling and both agree on a light behind them") {
    const std::string tracer = "embree"; // agreement_test.cpp checks that the other agrees
    std::vector<render::FilmImage> images;
    for (const auto strategy : {render::Strategy::mis, render::Strategy::light_only, render::Strategy::bsdf_only}) {
        render::RendererOptions options;
        options.strategy = strategy;
        options.seed = std::uint32_t(images.size());
        SceneBuilder b;
        b.set_film(24, 24);
        b.set_camera({0, -5, 1.2}, {0, 0, 0.2}, {0, 0, 1}, 30);
        b.scene.settings.value.max_depth = 3;
        b.instance(b.quad({-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}), b.diffuse(0.6f, 0.6f, 0.6f));
        b.instance(b.quad({-2, -2, 2}, {-2, 2, 2}, {2, 2, 2}, {2, -2, 2}), b.diffuse(0.4f, 0.4f, 0.4f), glm::dmat4(1),
                   scene::Emission{glm::vec3(3)});
        b.environment(glm::vec3(0.2f));
        slab(b, b.material("interface"), 0.3, {.interior = medium(b, 0.3f * ink_sigma)}, {0, 0, 1});
        b.instance(b.sphere(24, 48), b.diffuse(0.6f, 0.6f, 0.6f), placed({-0.6, 0.3, 1}, 0.4)); // half in it
        images.push_back(render_image(*make_renderer(tracer, options), b.scene, 256));
    }
    INFO(tracer);
    check_same_mean(images[0], images[1]);
    check_same_mean(images[0], images[2]);
}

TEST_CASE("borders: those of clear media change no sample, and surfaces without media are free") {
    const std::string tracer = "embree";
    const auto renderer = make_renderer(tracer);
    std::vector<render::FilmImage> images;
    std::vector<render::TraceStats> stats;
    for (const int shells : {0, 1, 5}) { // 1: the same medium on both sides
        SceneBuilder b;
        b.set_film(24, 24);
        b.set_camera({0, -5, 1.2}, {0, 0, 0.5}, {0, 0, 1}, 40);
        b.scene.settings.value.max_depth = 4;
        ground(b, 0.6f);
        b.instance(b.sphere(24, 48), b.material("dielectric"), placed({0, 0, 0.8}, 0.6));
        b.instance(b.quad({-1, -1, 3}, {-1, 1, 3}, {1, 1, 3}, {1, -1, 3}), b.diffuse(0, 0, 0), glm::dmat4(1),
                   scene::Emission{glm::vec3(3)});
        const auto clear = medium(b, glm::vec3(0)), thin = medium(b, glm::vec3(0));
        for (int i = 0; i < shells; ++i)
            slab(b, b.material("interface"), 0.7 + 0.1 * i, {.interior = clear, .exterior = shells == 1 ? clear : thin},
                 {0, 0, 0.9}, 2 + 0.1 * i);
        renderer->forget_scene();
        renderer->reset_stats();
        images.push_back(render_image(*renderer, b.scene, 16));
        stats.push_back(renderer->stats());
        CHECK(renderer->gpu_scene().features().borders == (shells == 5));
    }
    for (std::size_t k : {1u, 2u}) {
        double worst = 0;
        for (std::size_t i = 0; i < images[0].color.size(); ++i)
            worst = std::max(worst, double(glm::length(images[0].color[i] - images[k].color[i])));
        INFO(tracer << ", " << k);
        CHECK(worst < 1e-5);
        CHECK(stats[k].rays == stats[0].rays);
        CHECK(stats[k].shadow_rays == stats[0].shadow_rays);
    }
}

TEST_CASE("borders: a mix with a null component lets that fraction pass") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    const auto mix = [](SceneBuilder& b, scene::Id<scene::Material> first, scene::Id<scene::Material> second,
                        float amount) {
        scene::ParamSet p;
        p.set("first", {.type = model::ParamType::material, .material = first});
        p.set("second", {.type = model::ParamType::material, .material = second});
        p.set("amount", scene::Value::number(amount));
        return b.material("mix", p);
    };
    INFO(tracer);
    for (const bool filled : {false, true}) {
        if (tracer == "vulkan" && !filled) continue;
        SceneBuilder b;
        look_down(b, {0.3, 0.2, 10}); // off the diagonal of the quads
        b.environment(glm::vec3(1));
        const auto inner = mix(b, b.diffuse(0, 0, 0), b.material("interface"), 0.5f);
        const auto outer = mix(b, b.material("interface"), inner, 0.4f); // 0.6 + 0.4 * 0.5 pass
        const auto id = slab(b, outer, 0.4, {});
        if (filled)
            edit_instance(b, id, [&](auto& i) { i.media = scene::MediumInterface{.interior = medium(b, ink_sigma)}; });
        renderer->forget_scene();
        const auto image = render_image(*renderer, b.scene, 256);
        // both sides of the slab are decided independently
        check_color(image, 0.64 * glm::exp(-(filled ? 0.8 : 0.0) * glm::dvec3(ink_sigma)), 0.006);
        CHECK(mean_luminance(image).std_error < 0.003);
        // an edit removes the gaps
        b.scene.materials.set(outer, b.scene.materials[b.diffuse(0, 0, 0)], ++b.scene.clock);
        check_color(render_image(*renderer, b.scene, 4), glm::dvec3(0));
    }
    SceneBuilder b; // a shadow of it
    look_down(b, {8, 0, 10});
    ground(b, 0.5f);
    b.light({.kind = scene::LightKind::point, .value = glm::vec3(20), .light_to_world = placed({0.31, 0.22, 4})});
    b.instance(b.quad({-1, -1, 2}, {1, -1, 2}, {1, 1, 2}, {-1, 1, 2}),
               mix(b, b.material("interface"), b.diffuse(0.5f, 0.5f, 0.5f), 0.3f));
    renderer->forget_scene();
    const double d2 = 16 + 0.31 * 0.31 + 0.22 * 0.22;
    check_color(render_image(*renderer, b.scene, 256), glm::dvec3(0.7 * 0.5 / pi * 20 * 4 / (d2 * std::sqrt(d2))),
                0.02);
}

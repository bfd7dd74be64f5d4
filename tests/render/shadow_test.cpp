// SPDX-License-Identifier: Apache-2.0
// Ends of shadow rays: objects close to a lamp shade it, and no lamp shades itself.
#include "render/checks.hpp"

#include <catch2/generators/catch_generators.hpp>

using namespace restage;
using namespace restage::tests;
constexpr double pi = std::numbers::pi;

TEST_CASE("a lid before a lamp at 1e-5 of the distance shades it") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto strategy = GENERATE(render::Strategy::mis, render::Strategy::light_only);
    render::RendererOptions options;
    options.strategy = strategy;
    const auto renderer = make_renderer(tracer, options);
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1), 0.6, glm::dvec3(1, 0.4, -0.3));
    for (const double scale : {1.0, 1e-3, 1e4})
        for (const bool tilted : {false, true})
            for (const bool two_sided : {false, true}) {
                SceneBuilder b;
                const glm::dmat4 m = placed({0, 0, 0}, scale) * (tilted ? turned : glm::dmat4(1));
                const auto at = [&](glm::dvec3 p) { return glm::dvec3(m * glm::dvec4(p, 1)); };
                b.set_film(16, 16);
                b.set_camera(at({0.4, 0.1, 1}), at({0, 0, 0}), at({0, 1, 0}) / scale, 20);
                b.scene.settings.value.max_depth = 1;
                b.instance(b.quad({-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}), b.diffuse(1, 1, 1), m);
                b.instance(b.quad({-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}), b.diffuse(0, 0, 0), m,
                           scene::Emission{glm::vec3(5), two_sided});
                const float z = 2 - 2e-5f;
                b.instance(b.quad({-1.1f, -1.1f, z}, {-1.1f, 1.1f, z}, {1.1f, 1.1f, z}, {1.1f, -1.1f, z}),
                           b.diffuse(0, 0, 0), m);
                renderer->forget_scene();
                renderer->reset_stats();
                const auto image = render_image(*renderer, b.scene, 16);
                INFO(tracer << ", scale " << scale << (tilted ? ", tilted" : "") << (two_sided ? ", two-sided" : ""));
                CHECK(mean_luminance(image).value == 0);
                CHECK(renderer->stats().shadow_rays > 1000); // else nothing was tested
            }
}

TEST_CASE("no lamp shades itself, at grazing angles or far away") {
    const std::string tracer = GENERATE("embree", "vulkan");
    render::RendererOptions options;
    options.strategy = render::Strategy::light_only;
    const auto renderer = make_renderer(tracer, options);
    struct Case {
        const char* name;
        glm::dmat4 place{1};
        glm::dvec3 baked{0}; // where the mesh's own coordinates are
    };
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1), 1.1, glm::dvec3(1, 2, -0.5));
    for (const Case& c : {Case{"plain"},
                          {"stretched", glm::scale(turned, glm::dvec3(1, 1e-3, 100))},
                          {"baked at 1000", turned, {1000, -1000, 500}}})
        for (const double distance : {0.3, 3.0, 30.0, 300.0}) {
            SceneBuilder b;
            b.set_film(16, 16);
            b.set_camera({distance, 0, 0.5}, {distance, 0, 0}, {0, 1, 0}, 0.5f); // a patch of 0.4 cm
            b.scene.settings.value.max_depth = 1;
            b.instance(b.quad({-999, -999, 0}, {999, -999, 0}, {999, 999, 0}, {-999, 999, 0}), b.diffuse(1, 1, 1));
            scene::MeshData lamp{.triangles = {{0, 1, 2}, {0, 2, 3}}}; // a square of 0.2 at height 1, emitting down
            const glm::dmat4 to_object = glm::inverse(c.place * glm::translate(glm::dmat4(1), -c.baked));
            for (const glm::dvec2& p : {glm::dvec2(-0.1, -0.1), {-0.1, 0.1}, {0.1, 0.1}, {0.1, -0.1}})
                lamp.positions.emplace_back(to_object * glm::dvec4(p, 1, 1));
            const auto mesh = b.mesh(std::move(lamp));
            b.instance(mesh, b.diffuse(0, 0, 0), c.place * glm::translate(glm::dmat4(1), -c.baked),
                       scene::Emission{glm::vec3(float(distance * distance))});
            // L / pi * integral of cos cos / d^2 over the lamp as rounded to floats: at grazing angles their tilt
            // matters
            const auto& floats = b.scene.meshes[mesh].data->positions;
            const glm::dmat4 place = c.place * glm::translate(glm::dmat4(1), -c.baked);
            const auto world = [&](int i) { return glm::dvec3(place * glm::dvec4(floats[std::size_t(i)], 1)); };
            const glm::dvec3 u = world(3) - world(0), v = world(1) - world(0), area = glm::cross(u, v);
            double form = 0;
            const int n = 64;
            for (int i = 0; i < n * n; ++i) {
                const glm::dvec3 d =
                    world(0) + u * ((i % n + 0.5) / n) + v * ((i / n + 0.5) / n) - glm::dvec3(distance, 0, 0);
                const double d2 = glm::dot(d, d);
                form += d.z * std::abs(glm::dot(area, d)) / (d2 * d2) / (n * n) / pi * distance * distance;
            }
            renderer->forget_scene();
            INFO(tracer << ", " << c.name << " at " << distance);
            check_mean(render_image(*renderer, b.scene, 32), form, 2e-3);
        }
}

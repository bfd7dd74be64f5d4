// SPDX-License-Identifier: Apache-2.0
// The denoiser's guides: albedo and normal of surfaces seen in mirrors and through smooth glass, ids and depth of the
// first hit.
#include "render/checks.hpp"

#include <catch2/generators/catch_generators.hpp>

using namespace restage;
using namespace restage::tests;

TEST_CASE("guides look through mirrors and glass") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    SceneBuilder b;
    b.set_film(16, 16);
    b.set_camera({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 4);
    b.scene.film.value.filter = {
        .kind = scene::FilterKind::mitchell, .radius = glm::vec2(2), .params = glm::vec2(0.3f)};
    scene::ParamSet kr;
    kr.set("kr", scene::Value::color(0.8f, 0.6f, 0.4f));
    // two mirrors one after the other: towards -x, and down to a red floor
    const auto mirror = b.material("mirror", kr);
    const auto first = b.instance(b.quad({-1, -1, -1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, -1}), mirror);
    const auto second = b.instance(b.quad({-5, -1, -1}, {-3, -1, 1}, {-3, 1, 1}, {-5, 1, -1}), mirror);
    const auto wall =
        b.instance(b.quad({-9, -5, -5}, {-1.5f, -5, -5}, {-1.5f, 5, -5}, {-9, 5, -5}), b.diffuse(0.9f, 0.2f, 0.1f));
    b.environment(glm::vec3(1));
    const auto check = [&](const glm::vec3& albedo, const glm::vec3& normal) {
        const auto image = render_image(*renderer, b.scene, 64);
        glm::vec3 a(0), n(0);
        float depth = 0;
        std::size_t ids = 0;
        for (std::size_t i = 0; i < image.color.size(); ++i) {
            a += image.albedo[i] / 256.f;
            n += image.normal[i] / 256.f;
            depth += image.depth[i] / 256.f;
            ids += image.instance_id[i] == first.value;
        }
        INFO(tracer << ": albedo " << a.x << ' ' << a.y << ' ' << a.z << ", normal " << n.x << ' ' << n.y << ' '
                    << n.z);
        CHECK(glm::length(a - albedo) < 0.01f);
        CHECK(glm::length(glm::abs(n) - glm::abs(normal)) < 0.01f);
        CHECK(std::abs(depth - 3) < 0.01f);
        CHECK(ids == 256);
    };
    const glm::vec3 red(0.9f, 0.2f, 0.1f), tint(0.8f, 0.6f, 0.4f);
    check(red * tint * tint, {0, 0, 1});
    edit_instance(b, second, [&](auto& i) { i.hidden = true; }); // the first mirror shows the sky
    check({0, 0, 0}, {0, 0, 0});
    edit_instance(b, first, [&](auto& i) { i.material = b.diffuse(0.5f, 0.5f, 0.5f); });
    check(glm::vec3(0.5f), glm::vec3(std::sqrt(0.5f), 0, std::sqrt(0.5f)));
    // a pane of glass that lets nearly all pass: the wall behind it
    auto pane = numbers({{"eta", 1.0001f}});
    edit_instance(b, first, [&](auto& i) {
        i.material = b.material("dielectric", pane);
        i.mesh = b.quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
    });
    edit_instance(b, wall, [&](auto& i) { i.object_to_world = glm::translate(glm::dmat4(1), glm::dvec3(5, 0, -4)); });
    check(red, {0, 0, 1});
}

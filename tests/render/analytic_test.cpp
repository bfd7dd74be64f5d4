// SPDX-License-Identifier: Apache-2.0
// Light transport against closed forms, within 3 standard errors (plus float rounding if there is no noise).
#include "render/fixture.hpp"
#include "render/scene_builder.hpp"

#include <catch2/generators/catch_generators.hpp>

using namespace restage;
using namespace restage::tests;
constexpr double pi = std::numbers::pi;

namespace {

void check_mean(const render::FilmImage& image, double expected) {
    const Mean m = mean_luminance(image);
    INFO("mean " << m.value << " +- " << m.std_error << ", expected " << expected << ", z "
                 << (m.value - expected) / std::max(m.std_error, 1e-12));
    CHECK(std::abs(m.value - expected) <= 3 * m.std_error + 2e-4 * std::abs(expected));
    CHECK(m.std_error < 0.02 * std::abs(expected) + 1e-9); // else the first check is meaningless
}

// A camera high above the origin that sees a tiny patch of the plane z = 0.
void look_down(SceneBuilder& b) {
    b.set_film(16, 16);
    b.set_camera({0, 0, 10}, {0, 0, 0}, {0, 1, 0}, 0.05f);
}
scene::Id<scene::Instance> ground(SceneBuilder& b, float albedo) {
    return b.instance(b.quad({-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}),
                      b.diffuse(albedo, albedo, albedo));
}

} // namespace

TEST_CASE("environment: a diffuse plane under a constant sky reflects albedo times radiance") {
    const auto tracer = GENERATE("embree", "vulkan");
    SceneBuilder b;
    look_down(b);
    ground(b, 0.6f);
    b.environment(glm::vec3(1.5f));
    check_mean(render_image(*make_renderer(tracer), b.scene, 64), 0.6 * 1.5);
}

TEST_CASE("point light: inverse square and cosine") {
    const auto tracer = GENERATE("embree", "vulkan");
    SceneBuilder b;
    look_down(b);
    ground(b, 0.5f);
    glm::dmat4 m(1);
    m[3] = {3, 0, 4, 1}; // 5 away, cosine 0.8
    b.light({.kind = scene::LightKind::point, .value = glm::vec3(20), .light_to_world = m});
    check_mean(render_image(*make_renderer(tracer), b.scene, 16), 0.5 / pi * 20 / 25 * 0.8);
}

TEST_CASE("spot light: its edge fades as pbrt-v4's or as pbrt-v3's") {
    const auto tracer = GENERATE("embree", "vulkan");
    const auto falloff = GENERATE(scene::Falloff::smooth, scene::Falloff::quartic);
    SceneBuilder b;
    look_down(b);
    ground(b, 0.5f);
    const double height = 5, angle = 20 * pi / 180,
                 edge = 40 * pi / 180; // seen 20 degrees off its axis, all of it edge
    glm::dmat4 m = glm::rotate(glm::dmat4(1), pi, glm::dvec3(1, 0, 0)); // down
    m[3] = {height * std::tan(angle), 0, height, 1};
    b.light({.kind = scene::LightKind::spot,
             .value = glm::vec3(100),
             .light_to_world = m,
             .cone_angle = 40,
             .cone_delta = 40,
             .falloff = falloff});
    const double t = (std::cos(angle) - std::cos(edge)) / (1 - std::cos(edge));
    const double faded = falloff == scene::Falloff::quartic ? t * t * t * t : t * t * (3 - 2 * t);
    const double distance = height / std::cos(angle);
    check_mean(render_image(*make_renderer(tracer), b.scene, 16),
               0.5 / pi * 100 * faded * std::cos(angle) / (distance * distance)); // 0.441 and 0.160
}

TEST_CASE("distant light: irradiance times cosine") {
    const auto tracer = GENERATE("embree", "vulkan");
    SceneBuilder b;
    look_down(b);
    ground(b, 0.5f);
    b.light({.kind = scene::LightKind::distant,
             .value = glm::vec3(3),
             .light_to_world = glm::rotate(glm::dmat4(1), pi * 0.75, glm::dvec3(1, 0, 0))});
    check_mean(render_image(*make_renderer(tracer), b.scene, 16), 0.5 / pi * 3 * std::cos(pi / 4));
}

TEST_CASE("a light that is switched off emits nothing") {
    const auto tracer = GENERATE("embree", "vulkan");
    SceneBuilder b;
    look_down(b);
    ground(b, 0.5f);
    const glm::dmat4 down = glm::rotate(glm::dmat4(1), pi * 0.75, glm::dvec3(1, 0, 0));
    b.light({.kind = scene::LightKind::distant, .value = glm::vec3(5), .light_to_world = down, .hidden = true});
    b.light({.kind = scene::LightKind::distant, .value = glm::vec3(3), .light_to_world = down});
    check_mean(render_image(*make_renderer(tracer), b.scene, 16), 0.5 / pi * 3 * std::cos(pi / 4));
}

TEST_CASE("sphere light: form factor of a sphere") {
    const auto tracer = GENERATE("embree", "vulkan");
    SceneBuilder b;
    look_down(b);
    ground(b, 0.7f);
    const double r = 1, d = 4; // centre at 45 degrees, seen whole: E = pi L (r/d)^2 cos
    glm::dmat4 m(1);
    m[3] = {d * std::sin(pi / 4), 0, d * std::cos(pi / 4), 1};
    b.instance(b.sphere(96, 192, false, true), b.diffuse(0, 0, 0), m, scene::Emission{glm::vec3(5)});
    b.scene.settings.value.max_depth = 1;
    check_mean(render_image(*make_renderer(tracer), b.scene, 256),
               0.7 / pi * pi * 5 * (r * r) / (d * d) * std::cos(pi / 4));
}

TEST_CASE("triangle light over a plane: Lambert's formula") {
    const auto tracer = GENERATE("embree", "vulkan");
    const bool two_sided = GENERATE(false, true);
    SceneBuilder b;
    look_down(b);
    ground(b, 1.f);
    const glm::vec3 p[3] = {{1, 0.5f, 2}, {2, -1, 2.5f}, {3, 1, 1.5f}};
    // E = L/2 * sum of the edges' angles times the cosine of their planes' normals (Lambert 1760)
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 a = glm::normalize(glm::dvec3(p[i])), c = glm::normalize(glm::dvec3(p[(i + 1) % 3]));
        sum += std::acos(glm::dot(a, c)) * glm::normalize(glm::cross(a, c)).z;
    }
    const double irradiance = 2 / 2.0 * std::abs(sum);
    const bool faces_down = glm::dot(glm::cross(p[1] - p[0], p[2] - p[0]), p[0]) < 0;
    auto mesh = b.mesh(
        {.positions = {p[0], p[1], p[2]}, .triangles = {faces_down ? glm::uvec3(0, 1, 2) : glm::uvec3(0, 2, 1)}});
    const auto id = b.instance(mesh, b.diffuse(0, 0, 0), glm::dmat4(1), scene::Emission{glm::vec3(2), two_sided});
    b.scene.settings.value.max_depth = 1;
    auto renderer = make_renderer(tracer);
    check_mean(render_image(*renderer, b.scene, 256), irradiance / pi);
    // flipped, only the two-sided one lights the plane
    auto turned = b.scene.instances[id];
    turned.reverse_orientation = true;
    b.scene.instances.set(id, turned, ++b.scene.clock);
    check_mean(render_image(*renderer, b.scene, 256), two_sided ? irradiance / pi : 0);
}

TEST_CASE("a mirrored transform keeps the emitting side") {
    const auto tracer = GENERATE("embree", "vulkan");
    SceneBuilder b;
    look_down(b);
    ground(b, 1.f);
    // emits down; mirrored in x it still emits down, because the normal is transformed, not recomputed
    auto mesh = b.quad({-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2});
    b.set_camera({8, 0, 10}, {0, 0, 0}, {0, 1, 0}, 0.05f); // past the light
    b.instance(mesh, b.diffuse(0, 0, 0), glm::scale(glm::dmat4(1), glm::dvec3(-1, 1, 1)),
               scene::Emission{glm::vec3(2)});
    b.scene.settings.value.max_depth = 1;
    // a square of half side a at height h over the point: four times the corner formula
    const double a = 0.5 * 2 / 2.0, k = a / std::sqrt(1 + a * a); // x = y = a/h = 1/2
    const double form = 4 / (2 * pi) * 2 * k * std::atan(k);
    check_mean(render_image(*make_renderer(tracer), b.scene, 256), 2 * form);
}

TEST_CASE("a cut-out lamp emits from its remaining part, and a null surface completely") {
    const auto tracer = GENERATE("embree", "vulkan");
    const std::string left = GENERATE("half of it by alpha", "half of it in a mix", "interface");
    CAPTURE(left);
    SceneBuilder b;
    look_down(b);
    b.set_camera({8, 0, 10}, {0, 0, 0}, {0, 1, 0}, 0.05f); // past the light
    ground(b, 1.f);
    auto material = left == "interface" ? b.material("interface") : b.diffuse(0, 0, 0);
    if (left == "half of it in a mix") {
        scene::ParamSet p;
        p.set("first", {.type = model::ParamType::material, .material = material});
        p.set("second", {.type = model::ParamType::material, .material = b.material("interface")});
        p.set("amount", scene::Value::number(0.5f));
        material = b.material("mix", p);
    }
    const auto id = b.instance(b.quad({-1, -1, 2}, {-1, 1, 2}, {1, 1, 2}, {1, -1, 2}), material, glm::dmat4(1),
                               scene::Emission{glm::vec3(2)});
    auto lamp = b.scene.instances[id];
    if (left == "half of it by alpha") lamp.alpha = 0.5f;
    b.scene.instances.set(id, lamp, ++b.scene.clock);
    b.scene.settings.value.max_depth = 1;
    const double k = 0.5 / std::sqrt(1.25), whole = 2 * 4 / (2 * pi) * 2 * k * std::atan(k);
    check_mean(render_image(*make_renderer(tracer), b.scene, 1024), left == "interface" ? whole : 0.5 * whole);
}

TEST_CASE("furnace: a white diffuse sphere from inside") {
    const auto tracer = GENERATE("embree", "vulkan");
    SceneBuilder b;
    b.set_film(16, 16);
    b.set_camera({0.2, 0.1, 0}, {1, 0.3, 0.2}, {0, 0, 1}, 60);
    // albedo 1/2 and emission 1 at every bounce: 1 + 1/2 + 1/4 + ... = 2
    b.instance(b.sphere(), b.diffuse(0.5f, 0.5f, 0.5f), glm::dmat4(1), scene::Emission{glm::vec3(1), true});
    b.scene.settings.value.max_depth = 100;
    check_mean(render_image(*make_renderer(tracer), b.scene, 64), 2);
}

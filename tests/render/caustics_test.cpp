// SPDX-License-Identifier: Apache-2.0
// Photon maps of caustics: closed forms, and the same light as paths find where they can find it.
#include "render/checks.hpp"

#include <catch2/generators/catch_generators.hpp>
#include <numbers>

using namespace restage;
using namespace restage::tests;

namespace {

constexpr double albedo = 0.05; // of floors: light between floor and glass is below 1 % of it

void set_caustics(SceneBuilder& b, scene::Technique technique, std::uint32_t max_depth = 16) {
    b.scene.settings.value.caustics = technique;
    b.scene.settings.value.max_depth = max_depth;
    b.scene.settings.version = ++b.scene.clock;
}
scene::Light lamp(scene::LightKind kind, glm::vec3 value, const glm::dmat4& light_to_world) {
    scene::Light l;
    l.kind = kind;
    l.value = value;
    l.light_to_world = light_to_world;
    return l;
}
// From a lamp that shines along +z to one that shines along -z.
glm::dmat4 downwards(glm::dvec3 at) {
    return glm::translate(glm::dmat4(1), at) * glm::scale(glm::dmat4(1), {1, -1, -1});
}

// Looks at the floor around the origin from below everything else.
void watch_floor(SceneBuilder& b) {
    b.set_film(16, 16);
    b.set_camera({0, 0, 0.5}, {0, 0, 0}, {0, 1, 0}, 50);
    const auto color = float(albedo);
    b.instance(b.quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}), b.diffuse(color, color, color));
}

double mean_of(const std::string& tracer, SceneBuilder& b, std::uint32_t samples) {
    const auto renderer = make_renderer(tracer);
    return mean_luminance(render_image(*renderer, b.scene, samples)).value;
}

} // namespace

TEST_CASE("caustics: the sun through two panes of glass") {
    SceneBuilder b;
    const bool spectral = GENERATE(false, true);
    b.scene.settings.value.spectral = spectral;
    watch_floor(b);
    scene::ParamSet glass;
    glass.set("eta", scene::Value::number(1.5f));
    const auto pane = cube(b);
    for (const double z : {1.0, 1.2})
        b.instance(pane, b.material("dielectric", glass),
                   glm::translate(glm::dmat4(1), glm::dvec3(0, 0, z)) * glm::scale(glm::dmat4(1), {0.4, 0.4, 0.02}));
    const glm::vec3 color(2, 1.6f, 1); // greys would be rendered in RGB
    const double irradiance = glm::dot(glm::dvec3(color), {0.2126, 0.7152, 0.0722});
    b.light(lamp(scene::LightKind::distant, color, downwards({0, 0, 0})));
    set_caustics(b, scene::Technique::automatic, 40);
    // Four surfaces, all orders of reflection between them: Stokes 1862.
    const double r = std::pow(0.5 / 2.5, 2), through = (1 - r) / (1 + 3 * r);
    const double expected = albedo / std::numbers::pi * irradiance * through;
    const double mean = mean_of("embree", b, 256);
    INFO((spectral ? "spectral" : "RGB") << ", relative error " << mean / expected - 1);
    CHECK(std::abs(mean / expected - 1) < 0.01);
    set_caustics(b, scene::Technique::off, 40);
    CHECK(mean_of("embree", b, 16) < 0.02 * expected); // only by way of the floor outside
}

TEST_CASE("caustics: the sun of an environment image through two panes of glass") {
    SceneBuilder b;
    watch_floor(b);
    const auto pane = cube(b);
    for (const double z : {1.0, 1.2})
        b.instance(pane, b.material("dielectric", numbers({{"eta", 1.5f}})),
                   glm::translate(glm::dmat4(1), glm::dvec3(0, 0, z)) * glm::scale(glm::dmat4(1), {0.8, 0.8, 0.02}));
    const int width = 128, height = 64, column = 40, row = 5; // of the sun's texel
    const auto sky = [&](float sun) {
        std::vector<float> texels(std::size_t(width) * height, 0.1f);
        texels[std::size_t(row) * width + column] = sun;
        scene::Environment e{.name = "sky", .scale = glm::vec3(1)};
        e.image = b.image(width, height, 1, std::move(texels));
        b.scene.environment = {e, ++b.scene.clock};
    };
    const float sun = 10000;
    sky(sun);
    set_caustics(b, scene::Technique::automatic, 40);
    const auto renderer = make_renderer("embree");
    const double mean = mean_luminance(render_image(*renderer, b.scene, 1024)).value;
    CHECK(renderer->gpu_scene().sunny());
    set_caustics(b, scene::Technique::off, 40);
    const double sky_alone = [&] {
        sky(0.1f);
        return mean_luminance(render_image(*renderer, b.scene, 256)).value;
    }();
    CHECK(!renderer->gpu_scene().sunny());
    // Radiance is bilinear between the middles of texels: the sun is two by two texels, less at its edges. Four
    // surfaces as above, each with the mean of Fresnel's two reflectances.
    const double pi = std::numbers::pi, step = 1.0 / 32;
    double expected = 0;
    for (double v = -1 + step / 2; v < 1; v += step) {
        const double theta = (row + 0.5 + v) * pi / height, c = std::cos(theta),
                     t = std::sqrt(1 - (1 - c * c) / (1.5 * 1.5));
        const double s = (c - 1.5 * t) / (c + 1.5 * t), p = (1.5 * c - t) / (1.5 * c + t), r = (s * s + p * p) / 2;
        expected += double(sun - 0.1f) * (1 - std::abs(v)) * step * (pi / height) * (2 * pi / width) * std::sin(theta) *
                    c * (1 - r) / (1 + 3 * r);
    }
    const double error = (mean - sky_alone) / (albedo / pi * expected) - 1;
    INFO("relative error " << error << ", of the sky " << sky_alone / mean);
    CHECK(std::abs(error) < 0.02);
}

TEST_CASE("caustics: a mirror shows a floor its lamp a second time") {
    SceneBuilder b;
    watch_floor(b);
    const double height = 2, distance = 1.5; // of the lamp; of the mirror, at x = -distance
    b.instance(b.quad({-1.5f, -0.5f, 0.6f}, {-1.5f, 0.5f, 0.6f}, {-1.5f, 0.5f, 1.4f}, {-1.5f, -0.5f, 1.4f}),
               b.material("mirror"));
    const scene::LightKind kind = GENERATE(scene::LightKind::point, scene::LightKind::spot);
    scene::Light light = lamp(kind, glm::vec3(3), downwards({0, 0, height}));
    light.cone_angle = 89;
    light.cone_delta = 1;
    b.light(light);
    const auto lit = [&](scene::Technique technique) {
        set_caustics(b, technique);
        return mean_of("embree", b, 512);
    };
    const double with = lit(scene::Technique::automatic), without = lit(scene::Technique::off);
    // An image of the lamp stands behind the mirror.
    const double reflectance = 0.9; // the plugin's default
    const double seen = 0.5 * std::tan(glm::radians(25.0)); // half the side of the picture
    double direct = 0, mirrored = 0;
    for (int i = 0; i < 64; ++i)
        for (int j = 0; j < 64; ++j) {
            const double x = seen * ((i + 0.5) / 32 - 1), y = seen * ((j + 0.5) / 32 - 1);
            direct += height / std::pow(std::hypot(x, y, height), 3);
            mirrored += reflectance * height / std::pow(std::hypot(x + 2 * distance, y, height), 3);
        }
    const double error = (with - without) / without / (mirrored / direct) - 1;
    INFO("relative error " << error);
    CHECK(std::abs(error) < 0.02);
}

TEST_CASE("caustics: photons carry the light that paths find") {
    SceneBuilder b;
    b.set_film(24, 24);
    b.set_camera({0, -5, 2}, {0, 0, 0.4}, {0, 0, 1}, 40);
    ground(b, 0.4f);
    scene::ParamSet glass;
    glass.set("eta", scene::Value::number(1.5f));
    b.instance(b.sphere(), b.material("dielectric", glass), placed({0, 0, 0.8}, 0.6));
    const std::string light = GENERATE("quad", "sphere", "environment", "image");
    if (light == "environment") {
        b.environment(glm::vec3(0.5f, 0.4f, 0.3f));
    } else if (light == "image") { // half of it is darker than the mean
        std::vector<float> texels(32 * 16);
        for (std::size_t i = 0; i < texels.size(); ++i)
            texels[i] = i % 32 < 16 ? 0.3f : 0.9f;
        b.environment(glm::vec3(1));
        b.scene.environment.value->image = b.image(32, 16, 1, std::move(texels));
    } else if (light == "sphere")
        b.instance(b.sphere(16, 32), b.diffuse(0, 0, 0), placed({0.5, 0.3, 3}, 0.5),
                   scene::Emission{glm::vec3(4, 3, 2)});
    else
        b.instance(b.quad({-1, -1, 3}, {-1, 1, 3}, {1, 1, 3}, {1, -1, 3}), b.diffuse(0, 0, 0), glm::dmat4(1),
                   scene::Emission{glm::vec3(4, 3, 2)});
    const auto renderer = make_renderer("embree");
    set_caustics(b, scene::Technique::off);
    const Mean paths = mean_luminance(render_image(*renderer, b.scene, 1024));
    set_caustics(b, scene::Technique::on);
    const Mean photons = mean_luminance(render_image(*renderer, b.scene, 512));
    INFO(light << ": paths " << paths.value << " +- " << paths.std_error << ", photons " << photons.value << ": "
               << photons.value / paths.value - 1);
    CHECK(std::abs(photons.value - paths.value) <
          0.01 * paths.value + 3 * std::hypot(paths.std_error, photons.std_error));
    CHECK(photons.value != paths.value);
}

TEST_CASE("caustics: equal pictures in batches of any size, with and without other scenes before") {
    SceneBuilder b;
    b.set_film(40, 40);
    b.set_camera({0, -5, 2}, {0, 0, 0.4}, {0, 0, 1}, 40);
    ground(b, 0.4f);
    b.instance(b.sphere(), b.material("dielectric"), placed({0, 0, 0.8}, 0.6));
    b.light(lamp(scene::LightKind::point, glm::vec3(5), downwards({0.5, 0, 3})));
    b.scene.settings.value.adaptive = GENERATE(false, true);
    const auto renderer = make_renderer("embree");
    const render::FilmImage whole = render_image(*renderer, b.scene, 200);
    renderer->restart(7);
    REQUIRE(renderer->trace(3).has_value());
    CHECK((renderer->image().color != whole.color));
    renderer->restart(0);
    for (const std::uint32_t batch : {1u, 70u, 2u, 127u})
        REQUIRE(renderer->trace(batch).has_value());
    CHECK((renderer->image().color == whole.color));
    if (b.scene.settings.value.adaptive) return;
    renderer->reset();
    REQUIRE(renderer->trace(16).has_value());
    const auto sixteen = renderer->image().color;
    for (const int calls : {0, 1, 2, 3, 5, 8, 16}) { // while shaders compile and photons are on their way, too
        INFO("stopped at call " << calls);
        const auto stopped = make_renderer("embree");
        REQUIRE(stopped->sync(b.scene).has_value());
        int called = 0;
        REQUIRE(stopped->trace(16, [&] { return called++ < calls; }).has_value());
        if (stopped->samples() < 16) REQUIRE(stopped->trace(16 - stopped->samples()).has_value());
        CHECK((stopped->image().color == sixteen));
    }
}

TEST_CASE("caustics: scenes without casters are what they were") {
    SceneBuilder b;
    b.set_film(24, 24);
    b.set_camera({0, -5, 2}, {0, 0, 0.4}, {0, 0, 1}, 40);
    ground(b, 0.4f);
    const bool rough = GENERATE(false, true);
    b.instance(b.sphere(),
               rough ? b.material("dielectric", numbers({{"uroughness", 0.3f}, {"vroughness", 0.3f}}))
                     : b.diffuse(0.5f, 0.5f, 0.5f),
               placed({0, 0, 0.8}, 0.6));
    b.light(lamp(scene::LightKind::point, glm::vec3(5), downwards({0.5, 0, 3})));
    const auto renderer = make_renderer("embree");
    const render::FilmImage with = render_image(*renderer, b.scene, 8);
    CHECK(renderer->gpu_scene().features().caustics == rough); // what glass returns is known once it is hit
    set_caustics(b, scene::Technique::off, b.scene.settings.value.max_depth);
    const render::FilmImage without = render_image(*renderer, b.scene, 8);
    if (!rough) CHECK((without.color == with.color));
    double difference = 0; // another kernel may round differently
    for (std::size_t i = 0; i < with.color.size(); ++i)
        difference = std::max(difference, double(glm::distance(with.color[i], without.color[i])));
    CHECK(difference < 1e-5);
}

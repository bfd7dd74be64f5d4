// SPDX-License-Identifier: Apache-2.0
// Spectral mode: colours as smooth spectra, the choice of wavelengths, measured spectra, dispersion.
#include "shared/spectral.h"
#include "render/checks.hpp"
#include "render/kernel_lab.hpp"
#include "render/spectral_colors.hpp"
#include "render/spectral_fit.hpp"

#include <catch2/generators/catch_generators.hpp>

#include <numbers>
#include <random>

using namespace restage;
using namespace restage::tests;

namespace {

const render::SpectralColors& colors() {
    static Jobs jobs(2);
    return render::SpectralColors::get(jobs);
}

// RGB of a spectrum, relative to D65, at 1 nm.
template <class F>
glm::dvec3 seen(F&& spectrum) {
    glm::dvec3 sum(0), white(0);
    for (int nm = int(SPECTRAL_FIRST); nm <= int(SPECTRAL_LAST); ++nm) {
        sum += render::white_rgb_at(nm) * double(spectrum(nm));
        white += render::white_rgb_at(nm);
    }
    return sum / white;
}

double largest(const glm::dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

// Random, and the corners and edges of the cube.
std::vector<glm::vec3> some_colors() {
    std::mt19937 random(11);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<glm::vec3> out;
    for (int i = 0; i < 2000; ++i)
        out.emplace_back(unit(random), unit(random), unit(random));
    for (int i = 0; i < 27; ++i)
        out.emplace_back(0.5f * float(i % 3), 0.5f * float(i / 3 % 3), 0.5f * float(i / 9));
    out.emplace_back(1, 0.378676, 0.013473);
    return out;
}

// Sellmeier's formula for SF11.
double sf11(double nm) {
    const double l2 = nm * nm * 1e-6;
    return std::sqrt(1 + 1.73759695 * l2 / (l2 - 0.013188707) + 0.313747346 * l2 / (l2 - 0.0623068142) +
                     1.89878101 * l2 / (l2 - 155.23629));
}

// "spectrum:ID" of a value.
template <class F>
scene::OriginValue spectrum_of(const std::string& id, const glm::vec3& value, F&& at) {
    std::string text = fmt::format("{} {} {}", value.x, value.y, value.z);
    for (int nm = 360; nm <= 830; nm += 5)
        text += fmt::format(" {} {}", nm, at(double(nm)));
    return {"spectrum:" + id, text};
}

void make_spectral(SceneBuilder& b) {
    b.scene.settings.value.spectral = true;
    b.scene.settings.version = ++b.scene.clock;
}

} // namespace

TEST_CASE("spectral: a colour's spectrum has that colour") {
    double sum = 0;
    int close = 0, count = 0;
    for (const glm::vec3& rgb : some_colors()) {
        const glm::dvec3 c(colors().coefficients(rgb));
        const double error = largest(seen([&](int nm) { return render::smooth_spectrum(c, nm); }) - glm::dvec3(rgb));
        if (rgb.x == rgb.y && rgb.y == rgb.z) continue; // stored otherwise
        INFO(rgb.x << " " << rgb.y << " " << rgb.z << ": " << error);
        CHECK(error < 4e-3); // between the nodes near the cube's edges
        sum += error;
        close += error < 1e-3;
        ++count;
    }
    INFO("mean " << sum / count << ", " << close << " of " << count << " within 1e-3");
    CHECK(close > 0.98 * count);
    CHECK(sum / count < 5e-4);
    for (const float grey : {0.f, 1e-4f, 0.18f, 0.5f, 1.f}) { // exactly
        const auto s = render::spectrum_at(colors().reflectance(glm::vec3(grey)), 0.1f, {});
        CHECK((s.x == grey && s.y == grey && s.z == grey && s.w == grey));
    }
    const auto bright = render::spectrum_at(colors().unbounded(glm::vec3(7)), 0.7f, {});
    CHECK((bright.x == 7 && bright.w == 7));
}

TEST_CASE("spectral: shaders and C++ agree on the spectrum of a colour") {
    const auto cells = colors().cells();
    auto table = lab().device().create_buffer_of<glm::uvec2>(cells, "coefficients");
    REQUIRE(table);
    const auto list = some_colors();
    const auto got = lab().run<glm::vec4, glm::vec3>(
        "#define RESTAGE_SPECTRAL 1\n#include \"lib/spectral.glsl\"", "vec3", "vec4",
        "spectral_coefficients = root; host_wavelengths = vec4(420.0, 500.0, 580.0, 660.0);"
        "result = spectrum_from_rgb(x);",
        std::span<const glm::vec3>(list), table->address());
    double worst = 0;
    for (std::size_t i = 0; i < list.size(); ++i)
        for (int k = 0; k < 4; ++k) {
            const glm::vec3& c = list[i];
            const bool grey = c.x == c.y && c.y == c.z;
            const double expected =
                grey ? double(c.x) : render::smooth_spectrum(glm::dvec3(colors().coefficients(c)), 420 + 80 * k);
            worst = std::max(worst, std::abs(double(got[i][k]) - expected));
        }
    CHECK(worst < 2e-4);
}

TEST_CASE("spectral: wavelengths have the density of the film's weights") {
    for (const double u : {0.01, 0.3, 0.5, 0.77, 0.99}) {
        const double h = 1e-3, nm = double(shared::visible_wavelength(float(u)));
        const double slope =
            double(shared::visible_wavelength(float(u + h)) - shared::visible_wavelength(float(u - h)));
        const double pdf = 0.0039398042 / std::pow(std::cosh(0.0072 * (nm - 538)), 2);
        CHECK(std::abs(slope / (2 * h) * pdf - 1) < 2e-3);
    }
    CHECK(std::abs(double(shared::visible_wavelength(0)) - 360) < 0.01);
    CHECK(std::abs(double(shared::visible_wavelength(1)) - 830) < 0.01);
    // the mean over all numbers: of white light, and of a spectrum that depends on the wavelength
    const glm::dvec3 c(colors().coefficients({0.8f, 0.3f, 0.1f}));
    glm::dvec3 white(0), color(0);
    for (std::size_t i = 0; i < SPECTRAL_BINS; ++i) {
        const glm::dvec3 w = 4.0 * glm::dvec3(glm::vec3(colors().film()[i])) / double(SPECTRAL_BINS);
        white += w;
        const float u = (float(i) + 0.5f) / float(SPECTRAL_BINS);
        color += w * render::smooth_spectrum(c, double(shared::visible_wavelength(u)));
    }
    CHECK(largest(white - 1.0) < 1e-6);
    CHECK(largest(color - glm::dvec3(0.8, 0.3, 0.1)) < 1e-3);
}

TEST_CASE("spectral: a prism of SF11 splits light by Snell's law") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    constexpr double degrees = std::numbers::pi / 180, half = 20 * degrees; // of the refracting angle
    SceneBuilder b;
    b.set_film(4, 4);
    b.set_camera({-3, 0, 0}, {0, 0, 0}, {0, 0, 1}, 0.01f);
    b.scene.settings.value.max_depth = 2; // in and out, without reflections inside
    make_spectral(b);
    const auto index = float(sf11(587.56));
    scene::ParamSet params;
    params.set("eta", scene::Value::number(index));
    const auto glass = b.material("dielectric", params);
    auto material = b.scene.materials[glass];
    material.origin.values.push_back(spectrum_of("eta", glm::vec3(index), sf11));
    b.scene.materials.set(glass, material, ++b.scene.clock);
    const auto x = float(2 * std::tan(half));
    b.instance(
        b.mesh({.positions = {{0, 1, -1}, {-x, -1, -1}, {x, -1, -1}, {0, 1, 1}, {-x, -1, 1}, {x, -1, 1}},
                .triangles = {{0, 4, 3}, {0, 1, 4}, {0, 5, 2}, {0, 3, 5}, {1, 5, 4}, {1, 2, 5}, {0, 2, 1}, {3, 4, 5}}}),
        glass);
    // grey, and rising with the angle at which light leaves: 0 at 30 degrees, 1 at 60
    std::vector<float> sky;
    for (int row = 0; row < 8; ++row)
        for (int column = 0; column < 720; ++column) {
            const double angle = 360 - (column + 0.5) / 2;
            sky.push_back(angle >= 29 && angle <= 61 ? float((angle - 30) / 30 + 1) : 0.f);
        }
    b.scene.environment = {scene::Environment{.name = "sky", .image = b.image(720, 8, 1, sky)}, ++b.scene.clock};

    const auto transmitted = [](double cos_i, double cos_t, double n) { // unpolarized; n: beyond / before
        const double s = (cos_i - n * cos_t) / (cos_i + n * cos_t), p = (n * cos_i - cos_t) / (n * cos_i + cos_t);
        return 1 - 0.5 * (s * s + p * p);
    };
    const auto light_at = [&](double n) {
        const double r1 = std::asin(std::sin(half) / n), r2 = 2 * half - r1, out = std::asin(n * std::sin(r2));
        const double angle = (half + out - 2 * half) / degrees;
        return ((angle - 30) / 30 + 1) * transmitted(std::cos(half), std::cos(r1), n) *
               transmitted(std::cos(r2), std::cos(out), 1 / n);
    };
    const glm::dvec3 expected = seen([&](int nm) { return light_at(sf11(nm)); });
    const double of_one_index = light_at(double(index));
    const auto image = render_image(*renderer, b.scene, tracer == "embree" ? 16384 : 8192);
    glm::dvec3 mean(0);
    for (const glm::vec3& c : image.color)
        mean += glm::dvec3(c) / double(image.color.size());
    INFO("rendered " << mean.x << " " << mean.y << " " << mean.z << ", expected " << expected.x << " " << expected.y
                     << " " << expected.z << "; without dispersion " << of_one_index);
    const double noise = tracer == "embree" ? 2.6e-3 : 3.7e-3; // standard error of red; over 150 seeds
    CHECK(largest((mean - expected) / expected) < 3 * noise);
    CHECK(expected.z - expected.x > 0.04 * expected.y); // blue is bent more
    CHECK(std::abs((mean.z - mean.x) - (expected.z - expected.x)) < 4 * noise * expected.y);
}

TEST_CASE("spectral: a scene of greys is rendered in RGB, bit by bit") {
    const auto renderer = make_renderer("embree");
    SceneBuilder b;
    b.set_film(8, 8);
    b.set_camera({0, -4, 2}, {0, 0, 0.5}, {0, 0, 1}, 50);
    ground(b, 0.5f);
    b.environment(glm::vec3(1));
    const auto rgb = render_image(*renderer, b.scene, 4);
    make_spectral(b);
    if (auto ok = renderer->sync(b.scene); !ok) FAIL(ok.error().message);
    CHECK(renderer->samples() == 4); // not even restarted
    renderer->reset();
    const auto grey = render_image(*renderer, b.scene, 4);
    CHECK(!renderer->gpu_scene().features().spectral);
    CHECK((rgb.color == grey.color));
    b.instance(b.sphere(8, 16), b.diffuse(0.7f, 0.3f, 0.3f), placed({0, 0, 1}));
    const auto red = render_image(*renderer, b.scene, 4);
    CHECK(renderer->gpu_scene().features().spectral);
    CHECK((red.color != rgb.color));
}

TEST_CASE("spectral: both tracers agree: textures, images, media with borders, measured spectra") {
    SceneBuilder b;
    b.set_film(24, 24);
    b.set_camera({0, -5, 2.2}, {0, 0, 0.6}, {0, 0, 1}, 40);
    make_spectral(b);
    std::vector<float> texels, sky;
    for (int i = 0; i < 48; ++i)
        texels.push_back(float(i * 7 % 48) / 48);
    for (int i = 0; i < 16 * 8 * 3; ++i)
        sky.push_back(0.2f + float(i * 11 % 37) / 37);
    const auto texture = b.scene.textures.next();
    b.scene.textures.set(texture, scene::Texture{.name = "t", .type = "imagemap", .image = b.image(4, 4, 3, texels)},
                         ++b.scene.clock);
    auto textured = scene::Value::color(0.5f, 0.5f, 0.5f);
    textured.texture = texture;
    scene::ParamSet params;
    params.set("reflectance", textured);
    b.instance(b.quad({-3, -3, 0}, {3, -3, 0}, {3, 3, 0}, {-3, 3, 0}), b.material("diffuse", params));
    const auto smoke = b.scene.media.next();
    b.scene.media.set(smoke, scene::Medium{.name = "smoke", .sigma_a = {0.2f, 0.5f, 1.5f}}, ++b.scene.clock);
    const auto border = b.instance(cube(b), b.material("interface"), placed({-0.6, 0.3, 0.9}, 0.6));
    auto instance = b.scene.instances[border];
    instance.media = scene::MediumInterface{.interior = smoke, .exterior = {}};
    b.scene.instances.set(border, instance, ++b.scene.clock);
    const auto lamp = b.instance(b.quad({0.4f, 1.2f, 0.2f}, {1.8f, 1.2f, 0.2f}, {1.8f, 0.9f, 2}, {0.4f, 0.9f, 2}),
                                 b.diffuse(0.2f, 0.2f, 0.2f), glm::dmat4(1), scene::Emission{{3, 2, 1}, true});
    instance = b.scene.instances[lamp];
    instance.origin.values.push_back(spectrum_of("emission", {3, 2, 1}, [](double nm) { return nm / 500; }));
    b.scene.instances.set(lamp, instance, ++b.scene.clock);
    b.scene.environment = {scene::Environment{.name = "sky", .image = b.image(16, 8, 3, sky)}, ++b.scene.clock};

    const auto embree = make_renderer("embree"), vulkan = make_renderer("vulkan");
    const auto a = render_image(*embree, b.scene, 8), c = render_image(*vulkan, b.scene, 8);
    CHECK(embree->gpu_scene().features().curves);
    CHECK(embree->gpu_scene().features().borders);
    glm::dvec3 mean(0), other(0); // behind borders of media pixels differ by a percent, in RGB, too
    std::size_t different = 0;
    for (std::size_t i = 0; i < a.color.size(); ++i) {
        mean += glm::dvec3(a.color[i]);
        other += glm::dvec3(c.color[i]);
        different += largest(glm::dvec3(a.color[i] - c.color[i])) > 0.05 * (0.1 + largest(glm::dvec3(a.color[i])));
    }
    INFO("means " << mean.x << " " << mean.y << " " << mean.z << " and " << other.x << " " << other.y << " "
                  << other.z);
    CHECK(largest((mean - other) / mean) < 1e-3);
    CHECK(different <= 3); // a ray at an edge
}

TEST_CASE("spectral: a lamp with a spectrum has its colour, and an edited colour has no spectrum") {
    render::SpectralCurves curves;
    scene::Origin origin;
    const auto warm = [](double nm) { return nm - 300; };
    // its colour and luminance 1
    glm::dvec3 rgb(0);
    for (int nm = 360; nm <= 830; ++nm)
        rgb += render::white_rgb_at(nm) * warm(nm) / render::d65_at(nm);
    rgb /= glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722));
    origin.values.push_back(spectrum_of("value", glm::vec3(rgb), warm));
    const auto curve = curves.of_light(origin, "value", glm::vec3(3.0 * rgb)); // three times as bright
    REQUIRE(curve);
    const auto entries = curves.entries();
    const glm::dvec3 back = seen([&](int nm) { return entries[std::size_t(nm - 360)].x; });
    CHECK(largest(back - rgb) < 2e-3);
    CHECK(!curves.of_light(origin, "value", {1, 1, 1}));
    CHECK(!curves.of_value(origin, "value", glm::vec3(3.0 * rgb)));
    CHECK(!curves.of_light(origin, "emission", glm::vec3(rgb)));
    origin.values[0].text = "1 1 1 400"; // damaged
    CHECK(!curves.of_light(origin, "value", {1, 1, 1}));
}

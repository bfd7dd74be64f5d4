// SPDX-License-Identifier: Apache-2.0
// Skies: interpolated between texels; a one-pixel sun is found, rotates by pbrt's convention, and is equally bright in
// both mappings.
#include "render/checks.hpp"

#include <catch2/generators/catch_generators.hpp>

using namespace restage;
using namespace restage::tests;
constexpr double pi = std::numbers::pi;

namespace {

struct Mapping {
    scene::Mapping kind;
    std::uint32_t width, height;

    // pbrt-v3, InfiniteAreaLight (z up); pbrt-v4, EqualAreaSquareToSphere. u, v in [0,1], row 0 is v = 0.
    glm::dvec3 direction(double u, double v) const {
        if (kind == scene::Mapping::equirect) {
            const double theta = pi * v, phi = 2 * pi * u;
            return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
        }
        const double x = 2 * u - 1, y = 2 * v - 1, a = std::abs(x), b = std::abs(y), d = 1 - (a + b),
                     r = 1 - std::abs(d);
        const double phi = (r == 0 ? 1 : (b - a) / r + 1) * pi / 4, z = std::copysign(1 - r * r, d),
                     s = r * std::sqrt(2 - r * r);
        return {std::copysign(std::cos(phi), x) * s, std::copysign(std::sin(phi), y) * s, z};
    }
    // Integral of f(direction) over a texel's solid angle.
    template <class F>
    double integrate(std::uint32_t x, std::uint32_t y, F&& f) const {
        const int n = 16;
        double sum = 0;
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const double u = (x + (i + 0.5) / n) / width, v = (y + (j + 0.5) / n) / height;
                const double area = kind == scene::Mapping::equirect ? 2 * pi * pi * std::sin(pi * v) : 4 * pi;
                sum += f(direction(u, v)) * area / (double(width) * height * n * n);
            }
        return sum;
    }
    // Continuation of the square's plane, up to a texel outside: pbrt 4ed, fig. 3.22 for the octahedral map.
    glm::dvec2 wrap(double u, double v) const {
        if (kind == scene::Mapping::equirect) return {u - std::floor(u), v < 0 ? -v : v > 1 ? 2 - v : v};
        if (u < 0 || u > 1) u = u < 0 ? -u : 2 - u, v = 1 - v;
        if (v < 0 || v > 1) v = v < 0 ? -v : 2 - v, u = 1 - u;
        return {u, v};
    }
    // Integral of f(direction) over the solid angle, weighted by a texel's interpolation weight: a tent.
    template <class F>
    double integrate_tent(std::uint32_t x, std::uint32_t y, F&& f) const {
        const int n = 64;
        double sum = 0;
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                const double a = 2 * (i + 0.5) / n - 1, b = 2 * (j + 0.5) / n - 1;
                const glm::dvec2 p = wrap((x + 0.5 + a) / width, (y + 0.5 + b) / height);
                const double area = kind == scene::Mapping::equirect ? 2 * pi * pi * std::sin(pi * p.y) : 4 * pi;
                sum += (1 - std::abs(a)) * (1 - std::abs(b)) * f(direction(p.x, p.y)) * area * 4 /
                       (double(width) * height * n * n);
            }
        return sum;
    }
    // Bilinear between the centres of texels.
    double interpolate(const std::vector<float>& texels, double u, double v) const {
        double sum = 0;
        const double x = std::floor(u * width - 0.5), y = std::floor(v * height - 0.5);
        for (int k = 0; k < 4; ++k) {
            const double i = x + (k & 1), j = y + (k >> 1);
            const glm::dvec2 p = wrap((i + 0.5) / width, (j + 0.5) / height); // a centre: of a texel
            sum += (1 - std::abs(u * width - 0.5 - i)) * (1 - std::abs(v * height - 0.5 - j)) *
                   texels[std::size_t(p.y * height) * width + std::size_t(p.x * width)];
        }
        return sum;
    }
};

const Mapping equirect{scene::Mapping::equirect, 512, 256}, octahedral{scene::Mapping::octahedral, 256, 256};

// The texel that contains a direction.
glm::uvec2 texel_of(const Mapping& m, glm::dvec3 w) {
    glm::uvec2 best(0);
    double most = -2;
    for (std::uint32_t y = 0; y < m.height; ++y)
        for (std::uint32_t x = 0; x < m.width; ++x)
            if (const double c = glm::dot(w, m.direction((x + 0.5) / m.width, (y + 0.5) / m.height)); c > most) {
                most = c;
                best = {x, y};
            }
    return best;
}

void set_sky(SceneBuilder& b, const Mapping& m, std::vector<float> values, const glm::dmat4& turn) {
    b.scene.environment = {scene::Environment{.name = "sky",
                                              .image = b.image(m.width, m.height, 1, std::move(values)),
                                              .mapping = m.kind,
                                              .light_to_world = turn},
                           ++b.scene.clock};
}

} // namespace

namespace {

struct Sun {
    glm::dvec3 toward;
    glm::dmat4 turn; // of the sky
};
const Sun suns[] = {
    {glm::dvec3(0.5, 0.3, 0.8), glm::dmat4(1)},
    {glm::dvec3(-0.6, 0.5, 0.4), glm::rotate(glm::dmat4(1), 2.2, glm::dvec3(1, 0.5, 0.2))},
    {glm::dvec3(0.01, -0.005, 1), glm::dmat4(1)}, // in the row at the pole
    {glm::dvec3(0.5, 0.3, 0.8), glm::scale(glm::rotate(glm::dmat4(1), -0.3, glm::dvec3(0, 1, 1)), glm::dvec3(-30))},
};

} // namespace

TEST_CASE("a sun of one pixel in a dim sky is found, in any direction") {
    const std::string tracer = GENERATE("embree", "vulkan");
    for (const auto strategy : {render::Strategy::mis, render::Strategy::light_only}) {
        render::RendererOptions options;
        options.strategy = strategy;
        const auto renderer = make_renderer(tracer, options);
        for (const Mapping& m : {equirect, octahedral})
            for (const Sun& sun : suns) {
                const glm::dvec3 toward = sun.toward;
                const glm::dmat4 turn = sun.turn;
                const glm::dmat3 linear(turn);
                const glm::dmat3 rotation{glm::normalize(linear[0]), glm::normalize(linear[1]),
                                          glm::normalize(linear[2])};
                const auto at = texel_of(m, glm::normalize(glm::transpose(rotation) * toward));
                const double geometry =
                    m.integrate_tent(at.x, at.y, [&](const glm::dvec3& w) { return std::max(0.0, (rotation * w).z); });
                REQUIRE(geometry > 0);
                const double dim = 0.01, bright = 1 / geometry; // the sun gives an irradiance of 1, the sky 0.03
                std::vector<float> sky(std::size_t(m.width) * m.height, float(dim));
                sky[std::size_t(at.y) * m.width + at.x] = float(bright);
                SceneBuilder b;
                look_down(b);
                ground(b, 0.8f);
                set_sky(b, m, std::move(sky), turn);
                b.scene.settings.value.max_depth = 1;
                renderer->forget_scene();
                const auto image = render_image(*renderer, b.scene, 64);
                INFO(tracer << (strategy == render::Strategy::mis ? ", mis, " : ", light sampling, ")
                            << (m.kind == scene::Mapping::equirect ? "equirect" : "octahedral") << ", sun at texel "
                            << at.x << ", " << at.y);
                // tight: the sun gives nearly each sample the same value
                check_mean(image, 0.8 / pi * (pi * dim + (bright - dim) * geometry), 5e-4);
                const bool pole = m.kind == scene::Mapping::equirect && at.y == 0; // solid angle goes to 0 across it
                CHECK(mean_luminance(image).std_error < (pole ? 0.006 : 0.002));
            }
    }
}

TEST_CASE("the sky is interpolated between texels, also over seams and folds") {
    const std::string tracer = "embree"; // the other runs the same shader
    const auto renderer = make_renderer(tracer);
    for (const Mapping& m : {Mapping{scene::Mapping::equirect, 8, 4}, Mapping{scene::Mapping::octahedral, 6, 6}}) {
        std::vector<float> sky;
        for (std::uint32_t i = 0; i < m.width * m.height; ++i)
            sky.push_back(float((37 * i + 11) % 29));
        SceneBuilder b;
        set_sky(b, m, sky, glm::dmat4(1));
        b.set_film(2, 2);
        renderer->forget_scene();
        for (const glm::dvec2& p : {glm::dvec2(0.3, 0.6),
                                    {0.001, 0.4},
                                    {0.999, 0.7},
                                    {0.55, 0.05},
                                    {0.7, 0.97},
                                    {0.02, 0.03},
                                    {0.99, 0.52},
                                    {0.45, 0.985}}) {
            const glm::dvec3 w = m.direction(p.x, p.y);
            b.set_camera({0, 0, 0}, w, std::abs(w.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0), 1e-3f);
            const auto image = render_image(*renderer, b.scene, 2);
            const double expected = m.interpolate(sky, p.x, p.y);
            INFO((m.kind == scene::Mapping::equirect ? "equirect" : "octahedral")
                 << " at " << p.x << ", " << p.y << ": " << mean_luminance(image).value << ", expected " << expected);
            CHECK(std::abs(mean_luminance(image).value - expected) < 2e-3 * (1 + expected));
        }
    }
}

TEST_CASE("the same sky in both mappings gives the same irradiance") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    const auto radiance = [](const glm::dvec3& w) {
        return 1 + 0.7 * w.x - 0.5 * w.y * w.z +
               4 * std::pow(std::max(0.0, glm::dot(w, glm::normalize(glm::dvec3(1, 2, 2)))), 20);
    };
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1), 0.8, glm::dvec3(0.2, 1, 0.1));
    double expected = 0; // irradiance by quadrature over the upper hemisphere
    const int n = 400;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const double s2 = (j + 0.5) / n, phi = 2 * pi * (i + 0.5) / n; // uniform in the projected disk
            const glm::dvec3 w(std::sqrt(s2) * std::cos(phi), std::sqrt(s2) * std::sin(phi), std::sqrt(1 - s2));
            expected += radiance(glm::transpose(glm::dmat3(turn)) * w) * pi / (n * n);
        }
    for (const Mapping& m : {Mapping{scene::Mapping::equirect, 128, 64}, Mapping{scene::Mapping::octahedral, 96, 96}}) {
        std::vector<float> sky;
        for (std::uint32_t y = 0; y < m.height; ++y)
            for (std::uint32_t x = 0; x < m.width; ++x)
                sky.push_back(
                    float(m.integrate(x, y, radiance) / m.integrate(x, y, [](const glm::dvec3&) { return 1.0; })));
        SceneBuilder b;
        look_down(b);
        ground(b, 0.8f);
        set_sky(b, m, std::move(sky), turn);
        renderer->forget_scene();
        INFO(tracer << (m.kind == scene::Mapping::equirect ? ", equirect" : ", octahedral"));
        check_mean(render_image(*renderer, b.scene, 256), 0.8 / pi * expected, 1e-3);
    }
}

TEST_CASE("a sky hidden from the camera still emits light, and mirrors show it") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    const auto picture = [&](bool hidden, bool floor, const char* type) {
        SceneBuilder b;
        look_down(b);
        if (floor) {
            const auto quad = b.quad({-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0});
            b.instance(quad, type == std::string("mirror") ? b.material("mirror", {}) : b.diffuse(0.8f, 0.8f, 0.8f));
        } else { // outside the picture: a scene needs some geometry
            b.instance(b.quad({20, 0, 0}, {21, 0, 0}, {21, 1, 0}, {20, 1, 0}), b.diffuse(0.5f, 0.5f, 0.5f));
        }
        b.scene.environment = {scene::Environment{.name = "sky", .hidden_from_camera = hidden}, ++b.scene.clock};
        renderer->forget_scene();
        return render_image(*renderer, b.scene, 16);
    };
    INFO(tracer);
    CHECK(mean_luminance(picture(false, false, "")).value == 1);
    CHECK(mean_luminance(picture(true, false, "")).value == 0);
    check_mean(picture(true, true, "diffuse"), 0.8);
    check_same_mean(picture(true, true, "mirror"), picture(false, true, "mirror"));
}

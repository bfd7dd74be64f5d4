// SPDX-License-Identifier: Apache-2.0
// Spheres, disks and cylinders rendered exactly: closed forms, furnaces, lamps by every strategy, and
// fine triangles as an independent method. On both tracers.
#include "scene/quadric.hpp"
#include "render/agreement.hpp"
#include "render/checks.hpp"

#include <catch2/generators/catch_generators.hpp>

using namespace restage;
using namespace restage::tests;

namespace {

constexpr double pi = std::numbers::pi;

// The shape's surface as a grid over its (u, v), which represents it: exact, unless `triangles` is set.
scene::Id<scene::Mesh> shape(SceneBuilder& b, const std::string& line, bool triangles = false, int rows = 12) {
    scene::Mesh mesh{.name = line, .primitive = line};
    const auto q = scene::quadric_of(mesh);
    REQUIRE(q);
    scene::MeshData m;
    const int columns = 2 * rows;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) {
            const glm::dvec2 uv(double(i) / columns, double(j) / rows);
            m.positions.emplace_back(q->at(uv));
            const glm::dvec3 inside = q->at({uv.x, std::clamp(uv.y, 1e-6, 1 - 1e-6)}); // poles have no u
            m.normals.emplace_back(q->normal(q->kind == scene::Quadric::Kind::sphere ? inside : q->at(uv)));
            m.uvs.emplace_back(uv);
        }
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const std::uint32_t a = j * (columns + 1) + i, c = a + columns + 1;
            m.triangles.emplace_back(a, a + 1, c + 1);
            m.triangles.emplace_back(a, c + 1, c);
        }
    const auto id = b.mesh(std::move(m), line);
    if (!triangles) {
        scene::Mesh exact = b.scene.meshes[id];
        exact.primitive = line;
        b.scene.meshes.set(id, exact, ++b.scene.clock);
    }
    return id;
}

glm::dmat4 at(glm::dvec3 place, glm::dvec3 scale = glm::dvec3(1)) {
    glm::dmat4 m(1);
    for (int i = 0; i < 3; ++i)
        m[i][i] = scale[i];
    m[3] = glm::dvec4(place, 1);
    return m;
}

void check_radiance(const render::FilmImage& image, double expected, double widest_error, double slack = 0.001) {
    const Mean m = mean_luminance(image);
    INFO(m.value << " +- " << m.std_error << ", expected " << expected);
    CHECK(std::abs(m.value - expected) < 4 * m.std_error + slack * expected);
    CHECK(m.std_error < widest_error * expected);
}

// Looks at a spot of a floor of albedo 1/2 around the origin, straight down from a height.
struct Spot : SceneBuilder {
    explicit Spot(double height) {
        set_film(8, 8);
        set_camera({0, 0, height}, {0, 0, 0}, {0, 1, 0}, 1);
        instance(quad({-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}), diffuse(0.5f, 0.5f, 0.5f));
        scene.settings.value.max_depth = 1;
    }
    void lamp(const std::string& line, const glm::dmat4& place, bool triangles = false) {
        instance(shape(*this, line, triangles, triangles ? 96 : 12), diffuse(0, 0, 0), place,
                 scene::Emission{.radiance = glm::vec3(10), .two_sided = true});
    }
};

} // namespace

TEST_CASE("quadrics: the shape behind a mesh is read from its line") {
    const auto read = [](const char* line) { return scene::quadric_of(scene::Mesh{.primitive = line}); };
    const auto ball = read("sphere \"float radius\" [ 2.5 ]");
    REQUIRE(ball);
    CHECK(ball->whole_sphere());
    CHECK(std::abs(ball->area() - 4 * pi * 6.25) < 1e-9);
    const auto cap = read("sphere \"float radius\" 2 \"float zmin\" [1] \"float zmax\" 9 \"float phimax\" 90");
    REQUIRE(cap);
    CHECK_FALSE(cap->whole_sphere());
    CHECK(std::abs(cap->area() - pi / 2 * 2 * 1) < 1e-9);
    const auto ring = read("disk \"float innerradius\" 1 \"float radius\" 2 \"float height\" -3");
    REQUIRE(ring);
    CHECK(std::abs(ring->area() - 3 * pi) < 1e-9);
    CHECK(ring->at({0.25, 0}) == glm::dvec3(2 * std::cos(pi / 2), 2, -3));
    const auto tube = read("cylinder \"float zmax\" 3");
    REQUIRE(tube);
    CHECK(std::abs(tube->area() - 2 * pi * 4) < 1e-9);
    for (const auto& q : {*ball, *cap, *ring, *tube})
        for (const glm::dvec2& uv : {glm::dvec2(0.3, 0.6), {0.9, 0.2}})
            CHECK(glm::length(q.uv(q.at(uv)) - uv) < 1e-12);
    for (const char* line : {"", "cone \"float radius\" 1", "sphere \"float radius\" 0",
                             "sphere \"float radius\" [ 1 2 ]", "disk \"float radius\" 1 \"float innerradius\" 1",
                             "curve \"point3 P\" [ 0 0 0 ]", "sphere \"float radius\" 1\nsphere \"float radius\" 2"})
        CHECK_FALSE(read(line));
}

TEST_CASE("quadrics: lamps agree with their closed forms") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    const auto seen = [&](const std::string& line, const glm::dmat4& place, double height = 2) {
        Spot b(height);
        b.lamp(line, place);
        renderer->forget_scene();
        INFO(tracer << ": " << line);
        return render_image(*renderer, b.scene, 64);
    };
    // E = pi L (r/d)^2 of a sphere, radiance 1/2 E / pi; a cone's samples differ by the cosine only.
    check_radiance(seen("sphere \"float radius\" 0.5", at({0, 0, 10})), 5 * 0.05 * 0.05, 1e-4);
    check_radiance(seen("sphere \"float radius\" 0.01", at({0, 0, 10})), 5 * 1e-6, 1e-4);
    check_radiance(seen("sphere \"float radius\" 2", at({0, 0, 3}), 0.5), 5.0 * 4 / 9, 5e-3);
    check_radiance(seen("sphere \"float radius\" 1", at({0, 0, 10}, glm::dvec3(0.5))), 5 * 0.05 * 0.05, 1e-4);
    // E = pi L R^2 / (R^2 + h^2) below the middle of a disk; of a ring the difference of two.
    const auto form = [](double r, double h) { return r * r / (r * r + h * h); };
    check_radiance(seen("disk \"float radius\" 2", at({0, 0, 3})), 5 * form(2, 3), 8e-3);
    check_radiance(seen("disk \"float radius\" 2 \"float innerradius\" 1 \"float height\" 1", at({0, 0, 2})),
                   5 * (form(2, 3) - form(1, 3)), 8e-3);
    check_radiance(seen("disk \"float radius\" 2 \"float phimax\" 90", at({0, 0, 3})), 5 * form(2, 3) / 4, 8e-3);
    // From inside: a floor within a sphere that emits inwards sees nothing else.
    check_radiance(seen("sphere \"float radius\" 40", at({0, 0, 0})), 5, 2e-2);
    check_radiance(seen("sphere \"float radius\" 3 \"float zmin\" 0", at({0, 0, 0})), 5, 2e-2); // a dome
}

TEST_CASE("quadrics: every strategy gives the same lamp, as do triangles, at any scale") {
    const std::string tracer = GENERATE("embree", "vulkan");
    struct Case {
        const char* line;
        glm::dmat4 place;
    };
    glm::dmat4 sheared = at({0.3, -0.2, 1.2}, {0.9, 0.4, 0.5});
    sheared[1].x = 0.3;
    sheared[2].y = -0.2;
    for (const Case& c : {Case{"sphere \"float radius\" 1", sheared},
                          {"sphere \"float radius\" 0.8 \"float zmin\" -0.3 \"float zmax\" 0.6 \"float phimax\" 250",
                           at({0, 0, 1.1}, {1, 1.3, 1})},
                          {"cylinder \"float radius\" 0.3 \"float zmin\" -0.5 \"float zmax\" 0.7", sheared},
                          {"disk \"float radius\" 1 \"float innerradius\" 0.4", sheared}}) {
        const auto traced = [&](render::Strategy strategy, std::uint32_t seed, bool triangles) {
            Spot b(0);
            b.set_film(24, 24);
            b.set_camera({0, -4, 3}, {0, 0, 0.4}, {0, 0, 1}, 50);
            b.lamp(c.line, c.place, triangles);
            render::RendererOptions options;
            options.strategy = strategy;
            options.seed = seed;
            return render_image(*make_renderer(tracer, options), b.scene, 128);
        };
        INFO(tracer << ": " << c.line);
        const auto mis = traced(render::Strategy::mis, 1, false);
        // Means: a pixel's own error is unknown where BSDF sampling finds the lamp only rarely.
        const Mean a = mean_luminance(mis);
        const auto same = [&](const render::FilmImage& other, double slack, const char* what) {
            const Mean b = mean_luminance(other);
            INFO(a.value << " +- " << a.std_error << "; " << what << " " << b.value << " +- " << b.std_error);
            CHECK(std::abs(a.value - b.value) < 3.5 * std::hypot(a.std_error, b.std_error) + slack * a.value);
        };
        CHECK(a.value > 0.1);
        same(traced(render::Strategy::light_only, 2, false), 0, "by light sampling");
        same(traced(render::Strategy::bsdf_only, 3, false), 0, "by BSDF sampling");
        same(traced(render::Strategy::mis, 4, true), 0.003, "of triangles");
    }
}

TEST_CASE("quadrics: alpha is decided separately where a ray enters and where it leaves") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    {
        SceneBuilder b; // looks through the middle of a black ball at a sky of 1
        b.set_film(16, 16);
        b.set_camera({0, -5, 0}, {0, 0, 0}, {0, 0, 1}, 5);
        b.environment(glm::vec3(1));
        b.scene.settings.value.max_depth = 1;
        const auto ball = b.instance(shape(b, "sphere \"float radius\" 1"), b.diffuse(0, 0, 0));
        edit_instance(b, ball, [](scene::Instance& i) { i.alpha = 0.4f; });
        INFO(tracer);
        check_radiance(render_image(*renderer, b.scene, 256), 0.6 * 0.6, 0.02);
    }
    // A lamp: half of the rays end at the near side, a quarter at the far one, which only BSDF sampling finds.
    for (const auto strategy : {render::Strategy::mis, render::Strategy::bsdf_only}) {
        if (strategy != render::Strategy::mis && tracer == "vulkan") continue; // the same shaders, seconds to compile
        Spot b(0.5);
        b.lamp("sphere \"float radius\" 2", at({0, 0, 3}));
        edit_instance(b, scene::Id<scene::Instance>{2}, [](scene::Instance& i) { i.alpha = 0.5f; });
        render::RendererOptions options;
        options.strategy = strategy;
        INFO(tracer << ", strategy " << int(strategy));
        check_radiance(render_image(*make_renderer(tracer, options), b.scene, 1024), 0.75 * 5 * 4 / 9, 0.01);
    }
}

TEST_CASE("quadrics: no ray that leaves one hits it again") {
    // In a sky of 1 a white convex object is as bright as the sky, in every sample; so is smooth glass.
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    struct Case {
        const char* line;
        glm::dmat4 place;
        glm::dvec3 eye, look;
    };
    const Case cases[] = {
        {"sphere \"float radius\" 1", at({0, 0, 0}), {0, -3, 1}, {0, 0, 0}},
        {"sphere \"float radius\" 1000", at({0, 0, -1000}), {0, -5, 0.3}, {0, 0, 0}},
        {"sphere \"float radius\" 0.001", at({70, -30, 20}), {70, -30.003, 20.001}, {70, -30, 20}},
        {"sphere \"float radius\" 2", at({500, 0, 0}, {0.01, 3, 0.5}), {499.8, -7, 0.5}, {500, 0, 0}},
        {"cylinder \"float radius\" 1", at({0, 0, 0}), {0, -5, 0}, {0, 0, 0}},
        {"disk \"float radius\" 3", at({1, 2, 3}, glm::dvec3(100)), {1, -8, 5}, {1, 2, 3}},
    };
    for (const Case& c : cases) {
        SceneBuilder b;
        b.set_film(24, 24);
        b.set_camera(c.eye, c.look, {0, 0, 1}, 40);
        b.environment(glm::vec3(1));
        b.instance(shape(b, c.line), b.diffuse(1, 1, 1), c.place);
        b.scene.settings.value.max_depth = 1;
        renderer->forget_scene();
        const auto image = render_image(*renderer, b.scene, 64);
        // Light comes from the sky by both strategies; only rays that hit the shape itself would be missing.
        INFO(tracer << ": " << c.line);
        const Mean m = mean_luminance(image);
        INFO(m.value << " +- " << m.std_error);
        const bool hollow = std::string(c.line).starts_with("cylinder"); // its inside is visible, too
        CHECK(std::abs(m.value - 1) < (hollow ? 0.2 : 4 * m.std_error + 1e-4));
        const bool round = std::string(c.line).starts_with("sphere") && c.place[0].x == c.place[1].y;
        if (round) { // glass, in and out again; a flat ellipsoid would keep light for long
            scene::ParamSet p;
            p.set("eta", scene::Value::number(1.5f));
            const auto glass = b.material("dielectric", p);
            edit_instance(b, scene::Id<scene::Instance>{1}, [&](scene::Instance& i) { i.material = glass; });
            b.scene.settings.value.max_depth = 60;
            b.scene.settings.value.russian_roulette = false;
            const Mean g = mean_luminance(render_image(*renderer, b.scene, 4));
            INFO("glass " << g.value << " +- " << g.std_error);
            CHECK(std::abs(g.value - 1) < 1e-4);
        }
    }
}

TEST_CASE("quadrics: both tracers agree, with uv, cut-outs, parts and media") {
    SceneBuilder b;
    b.set_film(48, 48);
    b.set_camera({0, -7, 3}, {0, 0, 0.6}, {0, 0, 1}, 45);
    b.environment({0.5f, 0.6f, 0.8f});
    scene::ParamSet checks;
    const auto texture = b.scene.textures.next();
    scene::Texture t{.name = "checks", .type = "checkerboard"};
    t.params = numbers({{"uscale", 8.f}, {"vscale", 4.f}, {"tex1", 0.1f}, {"tex2", 0.8f}});
    b.scene.textures.set(texture, t, ++b.scene.clock);
    scene::Value v = scene::Value::color(1, 1, 1);
    v.texture = texture;
    checks.set("reflectance", v);
    const auto checked = b.material("diffuse", checks);
    b.instance(shape(b, "sphere \"float radius\" 1000"), checked, at({0, 0, -1000}));
    b.instance(shape(b, "sphere \"float radius\" 0.7"), checked, at({-1.6, 0, 0.7}));
    b.instance(shape(b, "sphere \"float radius\" 0.7 \"float zmin\" -0.2 \"float phimax\" 200"), checked,
               at({0, 0, 0.5}));
    b.instance(shape(b, "cylinder \"float radius\" 0.5 \"float zmin\" 0 \"float zmax\" 1.2 \"float phimax\" 300"),
               checked, at({1.5, 0.3, 0}));
    const auto ring =
        b.instance(shape(b, "disk \"float radius\" 1.2 \"float innerradius\" 0.5"), checked, at({0, 1, 1.7}));
    edit_instance(b, ring, [](scene::Instance& i) { i.alpha = 0.6f; });
    scene::ParamSet p;
    p.set("eta", scene::Value::number(1.5f));
    const auto ball =
        b.instance(shape(b, "sphere \"float radius\" 0.5"), b.material("dielectric", p), at({0.9, -1.5, 0.5}));
    const auto medium = b.scene.media.next();
    b.scene.media.set(medium, scene::Medium{.name = "tea", .sigma_a = {0.3f, 1, 2}}, ++b.scene.clock);
    edit_instance(b, ball, [&](scene::Instance& i) { i.media = scene::MediumInterface{medium, {}}; });
    const auto smoke =
        b.instance(shape(b, "sphere \"float radius\" 0.6"), b.material("interface"), at({-0.8, -1.6, 0.7}));
    edit_instance(b, smoke, [&](scene::Instance& i) { i.media = scene::MediumInterface{medium, {}}; });
    b.instance(shape(b, "sphere \"float radius\" 0.2"), b.diffuse(0, 0, 0), at({1, 1, 2.5}),
               scene::Emission{.radiance = glm::vec3(20)});
    const auto a = trace_scene("embree", b.scene, 64, 1), c = trace_scene("vulkan", b.scene, 64, 1),
               other = trace_scene("vulkan", b.scene, 64, 2);
    check_independent(a.image, other.image);
    CHECK(share_alike(a.image, c.image) > 0.5); // paths are the same except for cut-out decisions
}

TEST_CASE("quadrics: the limb of a large sphere matches the closed form") {
    // The fraction of the picture that a ball of radius 1000 covers, seen from 2 above it, at its horizon.
    const auto renderer = make_renderer("embree");
    SceneBuilder b;
    b.set_film(16, 64);
    b.set_camera({0, 0, 2}, {0, 100, -3.1}, {0, 0, 1}, 3);
    b.scene.settings.value.max_depth = 0;
    b.instance(shape(b, "sphere \"float radius\" 1000"), b.diffuse(0, 0, 0), at({0, 0, -1000}),
               scene::Emission{.radiance = glm::vec3(1)});
    const auto image = render_image(*renderer, b.scene, 64);
    const scene::Camera& camera = b.scene.cameras[b.scene.active_camera.value];
    double covered = 0, expected = 0;
    const double half = std::tan(glm::radians(1.5)); // of the shorter side, the width
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 16; ++x) {
            covered += image.color[std::size_t(y * 16 + x)].y;
            for (int k = 0; k < 64; ++k) {
                const double sx = ((x + (k % 8 + 0.5) / 8) / 16 * 2 - 1) * half;
                const double sy = (1 - (y + (k / 8 + 0.5) / 8) / 64 * 2) * half * 4;
                const glm::dvec3 d = glm::normalize(glm::dvec3(camera.camera_to_world * glm::dvec4(sx, sy, 1, 0)));
                const glm::dvec3 o(0, 0, 1002);
                const double lb = glm::dot(o, d);
                expected += (lb < 0 && lb * lb - (glm::dot(o, o) - 1e6) >= 0) / 64.0;
            }
        }
    CHECK(expected > 100);
    CHECK(std::abs(covered - expected) < 2);
}

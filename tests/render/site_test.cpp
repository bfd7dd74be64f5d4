// SPDX-License-Identifier: Apache-2.0
// The Site that materials may request: its values against closed forms, in both tracers, with a material that shows
// them as its albedo under a white sky, where one sample of the BSDF is free of noise.
#include "fixture.hpp"
#include "io/services.hpp"
#include "render/material_composer.hpp"
#include "scene_builder.hpp"

#include <catch2/generators/catch_generators.hpp>

using namespace restage;
using namespace restage::tests;

namespace {

struct Dots { // our plugins, and the one that shows its Site
    Log log;
    plugin::Registry registry{log, io::with_services()};
    Dots() {
        const plugin::SearchPath paths[] = {{restage::test::build_dir() / "lib/restage/plugins", true},
                                            {restage::test::source_dir() / "tests/plugins_site", true}};
        registry.scan(paths);
    }
    render::FilmImage image(const scene::Scene& scene, const std::string& tracer,
                            render::Strategy strategy = render::Strategy::bsdf_only, std::uint32_t samples = 1) {
        render::RendererOptions options{.tracer = tracer, .strategy = strategy};
        options.shader_dir = restage::test::source_dir() / "shaders";
        auto made = render::Renderer::create(options, render::material_lookup(registry), log);
        if (!made) FAIL(made.error().message);
        return render_image(**made, scene, samples);
    }
};

constexpr int width = 96, height = 64;
constexpr double fov = 40;
const double pixel = 2 * std::tan(glm::radians(fov / 2)) / height; // at distance 1 on the axis

struct Wall : SceneBuilder { // 4 x 4, around the origin, in the plane z = 0
    scene::Id<scene::Instance> wall;
    glm::dvec3 eye{0, 0, 3}, up{0, 1, 0};
    explicit Wall(const char* what, glm::dmat4 place = glm::dmat4(1), float size = 1) {
        set_film(width, height);
        environment(glm::vec3(1));
        scene::ParamSet p;
        p.set("what", scene::Value::choice(what));
        p.set("size", scene::Value::number(size));
        wall = instance(quad({-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}), material("dots", p), place);
        look_from(eye);
    }
    void look_from(glm::dvec3 from) { set_camera(eye = from, {0, 0, 0}, up, fov); }
    // Where the ray of a point of the film hits the wall (untransformed).
    glm::dvec3 meets(double x, double y) const {
        const glm::dvec3 f = glm::normalize(-eye), r = glm::normalize(glm::cross(up, f)), u = glm::cross(f, r);
        const glm::dvec3 d = f + pixel * ((x - width / 2) * r + (height / 2 - y) * u);
        return eye - d * (eye.z / d.z);
    }
};

glm::vec3 at(const render::FilmImage& image, int x, int y) { return image.color[std::size_t(y) * width + x]; }

} // namespace

TEST_CASE("the footprint of a pixel on a plane is that of a pinhole camera", "[site]") {
    const std::string tracer = GENERATE("embree", "vulkan");
    Dots dots;
    Wall wall("footprint");
    const auto facing = dots.image(wall.scene, tracer); // the same everywhere, exactly
    for (const auto& [x, y] : {std::pair{48, 32}, {10, 8}, {90, 60}})
        CHECK(std::abs(at(facing, x, y).x / (3 * pixel) - 1) < 1e-4);

    wall.look_from(3.0 * glm::dvec3(std::sin(0.3), -std::sin(1.0), std::cos(1.0)));
    const auto tilted = dots.image(wall.scene, tracer);
    for (const auto& [x, y] : {std::pair{48, 32}, {30, 24}, {70, 40}}) {
        const double dx = glm::length(wall.meets(x + 1, y + 0.5) - wall.meets(x, y + 0.5));
        const double dy = glm::length(wall.meets(x + 0.5, y + 1) - wall.meets(x + 0.5, y));
        INFO(x << ", " << y);
        CHECK(std::abs(at(tilted, x, y).x / std::max(dx, dy) - 1) < 0.04); // the ray is anywhere in the pixel
    }
}

TEST_CASE("uv and their changes, and lengths in the object's space, follow the surface", "[site]") {
    const std::string tracer = GENERATE("embree", "vulkan");
    Dots dots;
    const Wall by_uv("uv");
    const auto uv = dots.image(by_uv.scene, tracer);
    for (const auto& [x, y] : {std::pair{48, 32}, {20, 50}}) {
        const glm::dvec2 expected = glm::dvec2(by_uv.meets(x + 0.5, y + 0.5)) / 4.0 + 0.5;
        CHECK(glm::length(glm::dvec2(at(uv, x, y)) - expected) < pixel);
    }
    const Wall by_change("duv");
    const glm::vec3 duv = at(dots.image(by_change.scene, tracer), 48, 32);
    CHECK(std::abs(duv.x / (3 * pixel / 4) - 1) < 1e-3);
    CHECK(std::abs(duv.y / (3 * pixel / 4) - 1) < 1e-3);
    // Twice as large: the same pixels cover half as much of it.
    const Wall large("dp", glm::scale(glm::dmat4(1), glm::dvec3(2)));
    const glm::vec3 dp = at(dots.image(large.scene, tracer), 48, 32);
    CHECK(std::abs(dp.x / (3 * pixel / 2) - 1) < 1e-3);
    CHECK(std::abs(dp.y / (3 * pixel / 2) - 1) < 1e-3);
    const Wall by_normal("normal");
    CHECK(glm::length(at(dots.image(by_normal.scene, tracer), 48, 32) - glm::vec3(0.5f, 0.5f, 1.f)) < 1e-5f);
}

TEST_CASE("world positions are the scene's for any initial camera, and objects keep their number", "[site]") {
    const std::string tracer = GENERATE("embree", "vulkan");
    Dots dots;
    const Wall wall("world", glm::dmat4(1), 1);
    const glm::vec3 world = at(dots.image(wall.scene, tracer), 60, 20);
    const glm::dvec3 expected = glm::fract(wall.meets(60.5, 20.5));
    CHECK(glm::length(glm::dvec3(world) - expected) < 3 * pixel);

    Wall two("object");
    const auto more = two.instance(two.scene.instances[two.wall].mesh, two.scene.instances[two.wall].material,
                                   glm::translate(glm::dmat4(1), {2.2, 0, 0.5})); // before the left half
    const auto before = dots.image(two.scene, tracer);
    const glm::vec3 near_one = at(before, 3, 32), far_one = at(before, 80, 32);
    CHECK(near_one.x != far_one.x);
    auto moved = two.scene.instances[more];
    moved.object_to_world = glm::translate(glm::dmat4(1), {2.1, 0.1, 0.6});
    two.scene.instances.set(more, moved, ++two.scene.clock);
    const auto after = dots.image(two.scene, tracer);
    CHECK(at(after, 3, 32) == near_one);
    CHECK(at(after, 80, 32) == far_one);
}

TEST_CASE("both tracers show the same procedural", "[site]") {
    Dots dots;
    Wall wall("cubes", glm::rotate(glm::dmat4(1), 0.4, glm::dvec3(1, 2, 3)), 0.37f);
    const auto a = dots.image(wall.scene, "embree", render::Strategy::mis, 4);
    const auto b = dots.image(wall.scene, "vulkan", render::Strategy::mis, 4);
    double difference = 0, sum = 0;
    for (std::size_t i = 0; i < a.color.size(); ++i) {
        difference += glm::length(a.color[i] - b.color[i]);
        sum += glm::length(a.color[i]);
    }
    CHECK(difference < 1e-3 * sum);
    CHECK(sum > 0.1 * double(a.color.size()));
}

TEST_CASE("a material without the site flag contains no code for it", "[site]") {
    Dots dots;
    for (const plugin::MaterialEntry& entry : dots.registry.materials()) {
        render::MaterialType type;
        type.type = entry.table->type;
        type.plugin = {entry.table, entry.plugin->folder, entry.source};
        if (type.mix() || type.null_surface()) continue;
        const auto source = render::compose_material(type, "wave_shade.glsl", gpu::ShaderStage::compute);
        const bool asks = entry.table->site;
        CHECK((source.text.find("MATERIAL_SITE") != std::string::npos) == asks);
        CHECK((source.text.find("v1/site.glsl") != std::string::npos) == asks);
    }
}

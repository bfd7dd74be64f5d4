// SPDX-License-Identifier: Apache-2.0
// A third-party texture plugin without native code: as a colour, a bump map, a cut-out and the amount of a mix, in both
// tracers, against closed forms; and a reload of its GLSL.
#include "base/file.hpp"
#include "fixture.hpp"
#include "render/material_composer.hpp"
#include "render/texture_composer.hpp"
#include "scene_builder.hpp"
#include "temporary_folder.hpp"

#include <glm/gtc/constants.hpp>

#include <catch2/generators/catch_generators.hpp>

using namespace restage;
using namespace restage::tests;

namespace {

struct Steps { // our plugins, and one with steps in u, or by position
    test::TemporaryFolder folder;
    std::string said;
    Log log{[this](LogLevel level, std::string_view line) {
        if (level == LogLevel::error) said += std::string(line) + "\n";
    }};
    plugin::Registry registry{log};
    explicit Steps(bool site = false) {
        write(site ? "at.place.world.x / 4.0 + 0.5" : "at.uv.x", site);
        const std::filesystem::path shaders = restage::test::source_dir() / "shaders";
        const plugin::SearchPath paths[] = {{restage::test::build_dir() / "lib/restage/plugins", true},
                                            {folder.path(), true}};
        registry.scan(paths);
        REQUIRE(registry.find_texture("steps"));
        registry.set_judge(render::material_judge(shaders), render::texture_judge(shaders));
    }
    void write(const std::string& s, bool site, const std::string& result = "s < m.at ? m.low : m.high") {
        std::filesystem::create_directories(folder.path() / "steps");
        REQUIRE(write_file_atomic(folder.path() / "steps/plugin.json", std::string(R"({
            "id": "org.example.steps", "version": "1.0.0", "licence": "MIT", "provides": ["restage.texture/1"],
            "textures": [{"type": "steps", "label": "Steps", "prefix": "steps", "glsl": "steps.glsl", "flags": [)") +
                                                                           (site ? "\"site\"" : "\"mapped\"") +
                                                                           R"(], "params": [
              {"id": "low", "label": "Low", "type": "color", "default": [0, 0, 0], "flags": ["texturable"]},
              {"id": "high", "label": "High", "type": "color", "default": [1, 1, 1], "flags": ["texturable"]},
              {"id": "at", "label": "At", "type": "float", "default": 0.5}]}]})"));
        REQUIRE(write_file_atomic(folder.path() / "steps/steps.glsl",
                                  "Spectrum steps_texture(steps_Params m, TextureSite at) {\n    float s = " + s +
                                      ";\n    return " + result + ";\n}\n"));
    }
    std::unique_ptr<render::Renderer> renderer(const std::string& tracer,
                                               render::Strategy strategy = render::Strategy::bsdf_only) {
        render::RendererOptions options{.tracer = tracer, .strategy = strategy};
        options.shader_dir = restage::test::source_dir() / "shaders";
        auto made = render::Renderer::create(options, render::material_lookup(registry), log);
        if (!made) FAIL(made.error().message);
        return std::move(*made);
    }
    render::FilmImage image(const scene::Scene& scene, const std::string& tracer, std::uint32_t samples = 1) {
        return render_image(*renderer(tracer), scene, samples);
    }
};

constexpr int size = 16;

// A wall of 4 x 4 that fills the picture, under a white sky: each pixel is the albedo; u from 0 to 1 from left to
// right.
struct Wall : SceneBuilder {
    scene::Id<scene::Instance> wall;
    Wall() {
        set_film(size, size);
        set_camera({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, float(2 * glm::degrees(std::atan(0.5))));
        environment(glm::vec3(1));
        wall = instance(quad({-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}), diffuse(.25f, .25f, .25f));
    }
    scene::Id<scene::Texture> texture(const char* type, scene::ParamSet params = {}) {
        const auto id = scene.textures.next();
        scene.textures.set(id, scene::Texture{.name = type, .type = type, .params = std::move(params)}, ++scene.clock);
        return id;
    }
    scene::Id<scene::Texture> steps(float low, float high) {
        scene::ParamSet p;
        p.set("low", scene::Value::color(low, low, low));
        p.set("high", scene::Value::color(high, high, high));
        return texture("steps", p);
    }
    template <class F>
    void change(F&& f) {
        auto i = scene.instances[wall];
        f(i);
        scene.instances.set(wall, i, ++scene.clock);
    }
    void paint(scene::Id<scene::Texture> t) {
        scene::Value v = scene::Value::color(0, 0, 0);
        v.texture = t;
        scene::ParamSet p;
        p.set("reflectance", v);
        const auto m = material("diffuse", p);
        change([&](scene::Instance& i) { i.material = m; });
    }
};

float mean_of(const render::FilmImage& image, bool right) { // of one half of the picture
    float sum = 0;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size / 2; ++x)
            sum += image.color[std::size_t(y * size + x + (right ? size / 2 : 0))].x;
    return sum / (size * size / 2.f);
}
// u grows towards one side of the picture, which is known from the plain colour.
std::pair<float, float> halves(const render::FilmImage& image) {
    const float left = mean_of(image, false), right = mean_of(image, true);
    return {std::min(left, right), std::max(left, right)};
}

} // namespace

TEST_CASE("a texture plugin without native code is a colour", "[texture_plugin]") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const bool site = GENERATE(false, true);
    Steps steps(site);
    Wall b;
    b.paint(b.steps(0.2f, 0.7f));
    const auto [low, high] = halves(steps.image(b.scene, tracer));
    CHECK(std::abs(low - 0.2f) < 1e-5f);
    CHECK(std::abs(high - 0.7f) < 1e-5f);
    // Within a graph, and with another texture as one of its operands
    scene::ParamSet product;
    product.set("tex", scene::Value{.type = model::ParamType::color, .texture = b.steps(0.4f, 1.f)});
    product.set("scale", scene::Value::color(0.5f, 0.5f, 0.5f));
    scene::ParamSet outer;
    outer.set("high", scene::Value{.type = model::ParamType::color, .texture = b.texture("scale", product)});
    outer.set("low", scene::Value::color(0.1f, 0.1f, 0.1f));
    b.paint(b.texture("steps", outer));
    const auto [dark, light] = halves(steps.image(b.scene, tracer));
    CHECK(std::abs(dark - 0.1f) < 1e-5f);
    CHECK(std::abs(light - 0.5f) < 1e-5f);
    CHECK(steps.said.empty());
}

TEST_CASE("a texture plugin without native code cuts out, and is the amount of a mix", "[texture_plugin]") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const bool site = GENERATE(false, true);
    Steps steps(site);
    Wall b;
    const auto alpha = b.steps(0, 1);
    b.change([&](scene::Instance& i) { i.alpha_texture = alpha; });
    const auto cut = halves(steps.image(b.scene, tracer)); // the sky behind is 1
    CHECK(std::abs(cut.first - 0.25f) < 1e-5f);
    CHECK(std::abs(cut.second - 1) < 1e-5f);

    // A fraction: half of the rays pass where it is 0.5, through the first of two walls and through both
    const auto half = b.steps(0.5f, 0.5f);
    b.change([&](scene::Instance& i) { i.alpha_texture = half; });
    auto second = b.scene.instances[b.wall];
    second.object_to_world = glm::translate(glm::dmat4(1), {0, 0, -0.5}) * glm::scale(glm::dmat4(1), glm::dvec3(3));
    b.scene.instances.set(b.scene.instances.next(), second, ++b.scene.clock);
    const auto two = mean_luminance(steps.image(b.scene, tracer, 256));
    // Light between the walls is not 1 but the transmitted part: bounded from both sides by closed forms
    CHECK(two.value < 0.25 + 0.75 * 0.25 + 5 * two.std_error);
    CHECK(two.value > 0.25 + 5 * two.std_error);

    Wall m;
    const auto amount = m.steps(0, 1);
    scene::ParamSet p;
    p.set("first", scene::Value{.type = model::ParamType::material, .material = m.diffuse(.1f, .1f, .1f)});
    p.set("second", scene::Value{.type = model::ParamType::material, .material = m.diffuse(.6f, .6f, .6f)});
    p.set("amount", scene::Value{.type = model::ParamType::number, .texture = amount});
    const auto mix = m.material("mix", p);
    m.change([&](scene::Instance& i) { i.material = mix; });
    const auto mixed = halves(steps.image(m.scene, tracer));
    CHECK(std::abs(mixed.first - 0.1f) < 1e-5f);
    CHECK(std::abs(mixed.second - 0.6f) < 1e-5f);
}

TEST_CASE("shadow rays pass through cut-outs by a texture without native code", "[texture_plugin]") {
    const std::string tracer = GENERATE("embree", "vulkan");
    Steps steps;
    Wall b; // lit from the front by a distant light, through a card that is cut out on one side
    b.scene.environment = {std::nullopt, ++b.scene.clock};
    scene::Light sun;
    sun.kind = scene::LightKind::distant;
    sun.light_to_world = glm::rotate(glm::dmat4(1), glm::pi<double>(), glm::dvec3(0, 1, 0));
    b.light(sun);
    const auto lit = mean_luminance(render_image(*steps.renderer(tracer, render::Strategy::mis), b.scene, 4));
    REQUIRE(lit.value > 0.01);
    auto card = b.scene.instances[b.wall];
    card.object_to_world = glm::translate(glm::dmat4(1), {0, 0, 8}); // behind the camera, before the light
    card.alpha_texture = b.steps(0, 1);
    b.scene.instances.set(b.scene.instances.next(), card, ++b.scene.clock);
    const auto [dark, light] = halves(render_image(*steps.renderer(tracer, render::Strategy::mis), b.scene, 4));
    CHECK(dark < 1e-6f);
    CHECK(std::abs(light / lit.value - 1) < 1e-3);
}

TEST_CASE("a texture plugin is a bump map like any other", "[texture_plugin]") {
    const std::string tracer = GENERATE("embree", "vulkan");
    Steps steps;
    steps.write("0.8 * at.uv.x", false, "Spectrum(s)"); // 0.8 higher over the 4 units of the wall
    for (const plugin::Reload& r : steps.registry.reload_changed())
        CHECK(r.error.empty());
    Wall b;
    scene::ParamSet p;
    p.set("reflectance", scene::Value::color(.5f, .5f, .5f));
    p.set("bump", scene::Value{.type = model::ParamType::texture, .texture = b.steps(0, 1)});
    const auto slope = b.material("diffuse", p);
    b.change([&](scene::Instance& i) { i.material = slope; });
    const glm::vec3 n = steps.image(b.scene, tracer).normal[std::size_t(size) * size / 2 + size / 2];
    CHECK(std::abs(std::abs(n.x) - 0.2f / std::sqrt(1.04f)) < 1e-3f);
    CHECK(std::abs(std::abs(n.z) - 1 / std::sqrt(1.04f)) < 1e-3f);
}

TEST_CASE("the GLSL of a texture is reloaded, and a broken version is refused", "[texture_plugin][reload]") {
    const std::string tracer = GENERATE("embree", "vulkan");
    Steps steps;
    Wall b;
    b.paint(b.steps(0.2f, 0.7f));
    const auto renderer = steps.renderer(tracer);
    CHECK(std::abs(halves(render_image(*renderer, b.scene, 1)).first - 0.2f) < 1e-5f);
    steps.write("1.0 - at.uv.y * 0.0", false); // high everywhere
    for (const plugin::Reload& r : steps.registry.reload_changed())
        CHECK(r.error.empty());
    CHECK(std::abs(halves(render_image(*renderer, b.scene, 1)).first - 0.7f) < 1e-5f);
    steps.write("at.nonsense", false);
    const auto news = steps.registry.reload_changed();
    REQUIRE(news.size() == 1);
    CHECK(news[0].error.find("steps.glsl:2") != std::string::npos);
    CHECK(std::abs(halves(render_image(*renderer, b.scene, 1)).first - 0.7f) < 1e-5f);
}

TEST_CASE("a type without a plugin shades as its average", "[texture_plugin]") {
    const std::string tracer = GENERATE("embree", "vulkan");
    Steps steps;
    Wall b;
    scene::ParamSet p;
    p.set("average", scene::Value::color(.3f, .3f, .3f));
    b.paint(b.texture("unheard-of", p));
    CHECK(std::abs(halves(steps.image(b.scene, tracer)).first - 0.3f) < 1e-5f);
}

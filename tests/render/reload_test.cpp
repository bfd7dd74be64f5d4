// SPDX-License-Identifier: Apache-2.0
// A material whose plugin is reloaded while it is rendered: the picture follows, a version that does not compile
// changes nothing, and nothing of the old versions remains.
#include "base/file.hpp"
#include "io/services.hpp"
#include "paths.hpp"
#include "render/checks.hpp"
#include "render/material_composer.hpp"
#include "render/texture_composer.hpp"

#include <catch2/generators/catch_generators.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include "temporary_folder.hpp"

#include <thread>

using namespace restage;
using namespace restage::tests;

namespace {

// A diffuse material whose colour is in its GLSL, or in its parameter.
std::string glsl(const std::string& color) {
    std::string text = read_file(restage::test::source_dir() / "tests/data/paint.glsl").value();
    for (std::size_t at = 0; (at = text.find("COLOR", at)) != std::string::npos; at += color.size())
        text.replace(at, 5, color);
    return text;
}
std::string manifest(const std::string& params) {
    return R"({"id": "org.example.paint", "provides": ["restage.material/1"], "version": "1.0.0", "licence": "MIT", "needs": {"host": ">=0.2"},
"materials": [{"type": "paint", "glsl": "paint.glsl", "params": )" +
           params + "}]}";
}
const char* const one = R"([{"id": "gray", "type": "float", "default": 0.5}])";
const char* const two =
    R"([{"id": "tint", "type": "color", "default": [0.1, 0.2, 0.3]}, {"id": "gray", "type": "float", "default": 0.5}])";

struct Paint { // our plugins, and one that the test edits
    test::TemporaryFolder folder;
    std::string said;
    Log log{[this](LogLevel level, std::string_view line) {
        if (level == LogLevel::error) said += std::string(line) + "\n";
    }};
    plugin::Registry registry{log, io::with_services()};
    Paint() {
        write("vec3(m.gray)", one);
        const std::filesystem::path shaders = restage::test::source_dir() / "shaders";
        const plugin::SearchPath paths[] = {{restage::test::build_dir() / "lib/restage/plugins", true},
                                            {folder.path(), true}};
        registry.scan(paths);
        registry.set_judge(render::material_judge(shaders), render::texture_judge(shaders));
    }
    void write(const std::string& color, const char* params) {
        REQUIRE(write_file_atomic(folder / "plugin.json", manifest(params)));
        REQUIRE(write_file_atomic(folder / "paint.glsl", glsl(color)));
    }
    std::unique_ptr<render::Renderer> renderer(const std::string& tracer, bool stand_ins) {
        // A sample of the sky by the material only: each is the albedo, without noise.
        render::RendererOptions options{
            .tracer = tracer, .strategy = render::Strategy::bsdf_only, .stand_ins = stand_ins};
        options.shader_dir = restage::test::source_dir() / "shaders";
        auto made = render::Renderer::create(options, render::material_lookup(registry), log);
        if (!made) FAIL(made.error().message);
        return std::move(*made);
    }
};

// A wall that fills the picture, under a white sky: each pixel is the albedo.
struct Wall : SceneBuilder {
    scene::Id<scene::Material> paint = material("paint");
    Wall() {
        set_camera({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 30);
        set_film(8, 8);
        instance(quad({-9, -9, 0}, {9, -9, 0}, {9, 9, 0}, {-9, 9, 0}), paint);
        environment(glm::vec3(1));
    }
};

glm::vec3 color_of(render::Renderer& renderer, const scene::Scene& scene) {
    return render_image(renderer, scene, 1).color[8 * 4 + 4];
}
bool near(glm::vec3 a, glm::vec3 b) { return glm::length(a - b) < 1e-3f; }

} // namespace

TEST_CASE("the reload check accepts every shipped material", "[reload]") {
    Paint paint;
    const auto judge = render::material_judge(restage::test::source_dir() / "shaders");
    for (const plugin::MaterialEntry& entry : paint.registry.materials()) {
        const auto verdict = judge(entry);
        CHECK((verdict ? "" : verdict.error().message) == "");
    }
}

TEST_CASE("an edited plugin reaches a running renderer", "[reload]") {
    const std::string tracer = GENERATE("embree", "vulkan");
    Paint paint;
    Wall wall;
    const auto renderer = paint.renderer(tracer, false);
    CHECK(near(color_of(*renderer, wall.scene), glm::vec3(0.5f)));

    paint.write("vec3(0.9, 0.1, m.gray)", one);
    CHECK(near(color_of(*renderer, wall.scene), glm::vec3(0.5f))); // not picked up yet
    REQUIRE(paint.registry.reload_changed().size() == 1);
    CHECK(near(color_of(*renderer, wall.scene), {0.9f, 0.1f, 0.5f}));

    // Values are in the scene: they survive even a changed table.
    auto m = wall.scene.materials[wall.paint];
    m.params.set("gray", scene::Value::number(0.25f));
    wall.scene.materials.set(wall.paint, m, ++wall.scene.clock);
    paint.write("m.tint + vec3(m.gray)", two);
    REQUIRE(paint.registry.reload_changed().size() == 1);
    CHECK(near(color_of(*renderer, wall.scene), {0.35f, 0.45f, 0.55f}));
}

TEST_CASE("a version that does not compile changes nothing, and the error names the plugin's own line", "[reload]") {
    const std::string tracer = GENERATE("embree", "vulkan");
    Paint paint;
    Wall wall;
    const auto renderer = paint.renderer(tracer, false);
    CHECK(near(color_of(*renderer, wall.scene), glm::vec3(0.5f)));
    paint.write("vec3(m.grey)", one);
    const auto news = paint.registry.reload_changed();
    REQUIRE(news.size() == 1);
    CHECK_THAT(news[0].error, Catch::Matchers::ContainsSubstring((paint.folder / "paint.glsl").string() + ":4:"));
    CHECK_THAT(news[0].error, Catch::Matchers::ContainsSubstring("grey"));
    CHECK(near(color_of(*renderer, wall.scene), glm::vec3(0.5f)));
    // Also for a new renderer: the version on disk is not used.
    const auto another = paint.renderer(tracer, false);
    CHECK(near(color_of(*another, wall.scene), glm::vec3(0.5f)));
    paint.write("vec3(1) - vec3(0.1)", one);
    REQUIRE(paint.registry.reload_changed().size() == 1);
    CHECK(near(color_of(*renderer, wall.scene), glm::vec3(0.9f)));
}

TEST_CASE("a table of a hundred parameters: a texture affects only its own parameter", "[reload]") {
    const std::string tracer = GENERATE("embree", "vulkan");
    Paint paint;
    std::string params = "[";
    for (int i = 0; i < 100; ++i)
        params += (i ? ", " : "") + std::string(R"({"id": "c)") + std::to_string(i) +
                  R"(", "type": "color", "flags": ["texturable"], "default": [0.25, 0.25, 0.25]})";
    params += "]";
    // 6 and 70, 36 and 100 - 64: the same bit of a mask of 64.
    paint.write("vec3(m.c6.x, m.c70.y, m.c99.z)", params.c_str());
    REQUIRE(paint.registry.reload_changed().size() == 1);
    Wall wall;
    const auto texture = wall.scene.textures.next();
    wall.scene.textures.set(
        texture, scene::Texture{.name = "t", .type = "imagemap", .image = wall.image(1, 1, 3, {0.75f, 0.75f, 0.75f})},
        ++wall.scene.clock);
    auto m = wall.scene.materials[wall.paint];
    auto value = scene::Value::color(0, 0, 0);
    value.texture = texture;
    m.params.set("c70", value);
    wall.scene.materials.set(wall.paint, m, ++wall.scene.clock);
    const auto renderer = paint.renderer(tracer, false);
    CHECK(near(color_of(*renderer, wall.scene), {0.25f, 0.75f, 0.25f}));
}

TEST_CASE("while an editor renders, the previous version stays until the new one is compiled", "[reload]") {
    Paint paint;
    Wall wall;
    const auto renderer = paint.renderer("embree", true);
    const auto settled = [&](glm::vec3 color) {
        for (int i = 0; i < 3000; ++i) {
            REQUIRE(renderer->sync(wall.scene));
            REQUIRE(renderer->trace(1));
            if (!renderer->compiling() && near(renderer->image().color[36], color)) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    };
    REQUIRE(settled(glm::vec3(0.5f)));
    paint.write("vec3(0.2, 0.4, 0.6)", one);
    REQUIRE(paint.registry.reload_changed().size() == 1);
    REQUIRE(renderer->sync(wall.scene));
    REQUIRE(renderer->trace(1));
    const glm::vec3 meanwhile = renderer->image().color[36];
    CHECK((near(meanwhile, glm::vec3(0.5f)) || near(meanwhile, {0.2f, 0.4f, 0.6f})));
    CHECK(settled({0.2f, 0.4f, 0.6f}));
}

TEST_CASE("a hundred reloads leak no memory", "[reload]") {
    Paint paint;
    Wall wall;
    const auto renderer = paint.renderer("embree", false);
    const char* const colors[] = {"vec3(0.2)", "vec3(0.7)"};
    std::uint64_t after_ten = 0;
    for (int i = 0; i < 100; ++i) { // two texts: compiled code is in the caches after the second
        paint.write(colors[i % 2], i % 2 ? two : one);
        REQUIRE(paint.registry.reload_changed().size() == 1);
        REQUIRE(near(color_of(*renderer, wall.scene), glm::vec3(i % 2 ? 0.7f : 0.2f)));
        if (i == 10) after_ten = renderer->device().allocated_bytes();
    }
    CHECK(after_ten > 0);
    CHECK(renderer->device().allocated_bytes() == after_ten);
}

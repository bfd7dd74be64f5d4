// SPDX-License-Identifier: Apache-2.0
// Non-finite values never reach the film: they are counted under the name of the material type they came from.
#include "base/file.hpp"
#include "paths.hpp"
#include "render/checks.hpp"

#include <catch2/generators/catch_generators.hpp>

using namespace restage;
using namespace restage::tests;

namespace {

const model::Material bad_table{
    .type = "bad",
    .label = "Bad",
    .prefix = "bad",
    .glsl_file = "bad.glsl",
    .params = {{.id = "mode", .label = "Mode", .type = model::ParamType::integer, .int_max = 8}}};
// A white diffuse surface, except for the mode's fault.
const char* const bad_glsl = R"(
#include <restage/v1/sampling.glsl>
float bad_value(bad_Params m, int mode, float good) { return m.mode == mode ? uintBitsToFloat(0x7fc00000u) : good; }
Spectrum bad_eval(bad_Params m, vec3 wo, vec3 wi) { return Spectrum(bad_value(m, 1, same_hemisphere(wo, wi) ? abs(wi.z) * INV_PI : 0.0)); }
float bad_pdf(bad_Params m, vec3 wo, vec3 wi) { return bad_value(m, 2, same_hemisphere(wo, wi) ? abs(wi.z) * INV_PI : 0.0); }
BsdfSample bad_sample(bad_Params m, vec3 wo, vec3 u) {
    vec3 wi = sample_cosine_hemisphere(u.xy);
    if (wo.z < 0.0) wi.z = -wi.z;
    wi.x = bad_value(m, 3, wi.x);
    float weight = m.mode == 6 ? uintBitsToFloat(0x7f800000u) : bad_value(m, 4, 1.0);
    return BsdfSample(wi, Spectrum(weight), bad_value(m, 5, abs(wi.z) * INV_PI), BSDF_REFLECT, 1.0);
}
Spectrum bad_albedo(bad_Params m, vec3 wo) { return Spectrum(1); }
)";

bool all_finite(const render::FilmImage& image) {
    return std::ranges::all_of(image.color, [](const glm::vec3& c) { return std::isfinite(c.x + c.y + c.z); }) &&
           std::ranges::all_of(image.std_error, [](const glm::vec3& c) { return std::isfinite(c.x + c.y + c.z); });
}

} // namespace

TEST_CASE("a material's non-finite values are counted under its name") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto folder = restage::test::build_dir() / "test_cache/bad_material";
    std::filesystem::create_directories(folder);
    REQUIRE(write_file_atomic(folder / "bad.glsl", bad_glsl));
    render::RendererOptions options;
    options.tracer = tracer;
    options.shader_dir = restage::test::source_dir() / "shaders";
    const auto lookup = [&](const std::string& type) {
        return type == "bad" ? render::MaterialPlugin{&bad_table, folder} : plugins().lookup()(type);
    };
    auto created = render::Renderer::create(options, lookup, plugins().log);
    REQUIRE(created);
    auto& renderer = **created;
    const char* const modes[] = {"nothing", "eval", "pdf", "wi", "weight", "the sample's pdf", "an infinite weight"};
    SceneBuilder b;
    b.set_film(16, 16);
    b.set_camera({0, -6, 2}, {0, 0, 0}, {0, 0, 1}, 40);
    const auto bad = b.material("bad");
    b.instance(cube(b), bad, placed({-1.2, 0, 0}));
    b.instance(cube(b), b.diffuse(0.5f, 0.5f, 0.5f), placed({1.2, 0, 0}));
    b.environment(glm::vec3(1));
    b.light({.kind = scene::LightKind::point, .value = glm::vec3(10), .light_to_world = placed({0, -3, 4})});
    for (int mode = 0; mode < 7; ++mode) {
        auto material = b.scene.materials[bad];
        material.params.set("mode", scene::Value::integer(mode));
        b.scene.materials.set(bad, material, ++b.scene.clock);
        renderer.reset_stats();
        REQUIRE(renderer.sync(b.scene));
        REQUIRE(renderer.trace(8));
        const auto image = renderer.image();
        const auto& counted = renderer.stats().not_finite;
        INFO(tracer << ": not finite: " << modes[mode]);
        CHECK(all_finite(image));
        CHECK(image.samples == 8); // a dropped sample counts as black
        CHECK((counted.contains("bad") && counted.at("bad") > 50) == (mode > 0));
        CHECK(counted.size() == (mode > 0 ? 1u : 0u));
    }
}

TEST_CASE("a sky too bright for the film is dropped, counted, and does not affect error estimates") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const auto renderer = make_renderer(tracer);
    for (const float bright : {1e15f, 1e20f, 1e38f}) { // a square of 1e20 overflows
        SceneBuilder b;
        b.set_film(16, 16);
        b.set_camera({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 100);
        b.instance(b.quad({-4, -4, 0}, {0, -4, 0}, {0, 4, 0}, {-4, 4, 0}), b.diffuse(0, 0, 0)); // half of it
        b.scene.environment = {scene::Environment{.name = "sky", .image = b.image(2, 1, 1, {bright, bright})},
                               ++b.scene.clock}; // as a constant it would be refused, see the next test
        renderer->forget_scene();
        renderer->reset_stats();
        REQUIRE(renderer->sync(b.scene));
        REQUIRE(renderer->trace(4));
        const auto image = renderer->image();
        INFO(tracer << ", radiance " << bright);
        CHECK(all_finite(image));
        CHECK(image.samples == 4); // a dropped sample counts as black
        if (bright < 1e16f)
            CHECK(renderer->stats().dropped == 0);
        else
            CHECK(renderer->stats().dropped > 4 * 16 * 7); // half of them, or a little more
        CHECK((mean_luminance(image).value > 0) == (bright < 1e16f));
    }
}

TEST_CASE("a constant sky too bright for any film is refused with a message") {
    const auto renderer = make_renderer("embree");
    SceneBuilder b;
    b.set_film(16, 16);
    b.set_camera({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 100);
    b.environment(glm::vec3(1e20f));
    const auto synced = renderer->sync(b.scene);
    REQUIRE_FALSE(synced);
    CHECK(synced.error().message.find("environment") != std::string::npos);
}

TEST_CASE("a texture with NaN does not spoil the picture, and is named in the log") {
    const std::string tracer = GENERATE("embree", "vulkan");
    SceneBuilder b;
    b.set_film(16, 16);
    b.set_camera({0, 0, 3}, {0, 0, 0}, {0, 1, 0}, 100);
    const auto image = b.image(2, 1, 3, {NAN, NAN, NAN, 0.5f, 0.5f, 0.5f});
    const auto texture = b.scene.textures.next();
    scene::ParamSet wrap;
    wrap.set("wrap", scene::Value::choice("clamp"));
    b.scene.textures.set(texture, scene::Texture{.name = "t", .type = "imagemap", .image = image, .params = wrap},
                         ++b.scene.clock);
    scene::ParamSet p;
    auto value = scene::Value::color(1, 1, 1);
    value.texture = texture;
    p.set("reflectance", value);
    b.instance(b.quad({-4, -4, 0}, {4, -4, 0}, {4, 4, 0}, {-4, 4, 0}), b.material("diffuse", p));
    b.scene.environment = {scene::Environment{.name = "sky", .image = b.image(2, 1, 1, {1, -NAN})}, ++b.scene.clock};
    render::RendererOptions options;
    options.tracer = tracer;
    options.shader_dir = restage::test::source_dir() / "shaders";
    std::vector<std::string> warnings;
    Log log([&](LogLevel level, std::string_view line) {
        if (level == LogLevel::warning) warnings.emplace_back(line);
    });
    auto created = render::Renderer::create(options, plugins().lookup(), log);
    REQUIRE(created);
    const auto& renderer = *created;
    REQUIRE(renderer->sync(b.scene));
    REQUIRE(renderer->sync(b.scene));
    CHECK(warnings == std::vector<std::string>{
                                                // once each
                          "image \"image\": 3 of 6 values are not finite numbers; replaced by 0",
                          "environment \"sky\": 3 values of its image are negative or not finite; replaced by 0"});
    REQUIRE(renderer->trace(4));
    CHECK(all_finite(renderer->image()));
    CHECK(mean_luminance(renderer->image()).value > 0.1); // the other half of it is intact
}

// SPDX-License-Identifier: Apache-2.0
// Cubes in space against closed forms, and pictures of every type of texture before and after a round trip through
// pbrt.
#include "fixture.hpp"
#include "io/export.hpp"
#include "io/import.hpp"
#include "scene_builder.hpp"
#include "temporary_folder.hpp"

#include <catch2/generators/catch_generators.hpp>
#include <glm/gtc/constants.hpp>

using namespace restage;
using namespace restage::tests;

namespace {

// A wall that fills the picture, x and y from -2 to 2, under a white sky: each pixel is the albedo.
struct Wall : SceneBuilder {
    Wall() {
        set_film(24, 24);
        set_camera({0, 0, 4}, {0, 0, 0}, {0, 1, 0}, float(2 * glm::degrees(std::atan(0.5))));
        environment(glm::vec3(1));
    }
    scene::Id<scene::Material> paint(std::string type, scene::ParamSet params, scene::Id<scene::Image> image = {}) {
        const auto id = scene.textures.next();
        scene.textures.set(id, scene::Texture{.name = type, .type = type, .image = image, .params = std::move(params)},
                           ++scene.clock);
        scene::ParamSet p;
        p.set("reflectance", scene::Value{.type = model::ParamType::color, .texture = id});
        return material("diffuse", p);
    }
};

} // namespace

TEST_CASE("the mean of cubes in space agrees with the closed form", "[texture_plugin]") {
    const std::string tracer = GENERATE("embree", "vulkan");
    constexpr float a = 0.8f, b = 0.2f;
    struct Case {
        const char* name;
        std::vector<std::pair<const char*, float>> placing;
        float first; // fraction of the wall
    };
    const Case cases[] = {
        {"as the scene, between planes", {{"origin_z", 0.5f}}, 0.5f},
        {"one cube",
         {{"x_from_x", 0.25f}, {"origin_x", 0.5f}, {"y_from_y", 0.25f}, {"origin_y", 0.5f}, {"origin_z", 0.5f}},
         1},
        {"its neighbour in z",
         {{"x_from_x", 0.25f}, {"origin_x", 0.5f}, {"y_from_y", 0.25f}, {"origin_y", 0.5f}, {"origin_z", -0.5f}},
         0},
        // y from -1 to 2 over the wall: one of three rows is even
        {"rows",
         {{"x_from_x", 0.25f}, {"origin_x", 0.5f}, {"y_from_y", 0.75f}, {"origin_y", 0.5f}, {"origin_z", 0.5f}},
         1.f / 3},
        // The same rows from the scene's x, in the texture's z
        {"turned",
         {{"x_from_x", 0},
          {"origin_x", 0.5f},
          {"y_from_y", 0},
          {"origin_y", 0.5f},
          {"z_from_z", 0},
          {"z_from_x", 0.75f},
          {"origin_z", 0.5f}},
         1.f / 3},
        // A diagonal: x + y over 0 for half of the wall
        {"diagonal",
         {{"x_from_x", 0.25f}, {"x_from_y", 0.25f}, {"y_from_y", 0}, {"origin_y", 0.5f}, {"origin_z", 0.5f}},
         0.5f},
    };
    const auto renderer = make_renderer(tracer, {.strategy = render::Strategy::bsdf_only});
    Wall w;
    w.instance(w.quad({-2, -2, 0}, {2, -2, 0}, {2, 2, 0}, {-2, 2, 0}), w.paint("checkerboard3d", {}));
    for (const Case& c : cases) {
        INFO(tracer << ", " << c.name);
        scene::Texture t = w.scene.textures[scene::Id<scene::Texture>{1}];
        t.params = {};
        t.params.set("tex1", scene::Value::color(a, a, a));
        t.params.set("tex2", scene::Value::color(b, b, b));
        for (const auto& [id, v] : c.placing)
            t.params.set(id, scene::Value::number(v));
        w.scene.textures.set(scene::Id<scene::Texture>{1}, t, ++w.scene.clock);
        const Mean mean = mean_luminance(render_image(*renderer, w.scene, 64));
        CHECK(std::abs(mean.value - double(c.first * a + (1 - c.first) * b)) <= 5 * mean.std_error + 1e-5);
    }
}

TEST_CASE("each type of texture looks the same after a pbrt file", "[texture_plugin]") {
    const std::string version = GENERATE("v4", "v3");
    INFO(version);
    Wall w;
    const auto image = w.image(2, 2, 3, {.9f, .1f, .1f, .1f, .9f, .1f, .1f, .1f, .9f, .5f, .5f, .5f});
    const auto types = plugins().registry.textures();
    const int side = int(std::ceil(std::sqrt(double(types.size()))));
    w.set_film(std::uint32_t(12 * side), std::uint32_t(12 * side));
    int at = 0;
    for (const plugin::TextureEntry& entry : types) { // a tile of each, with visible values
        const model::Texture& table = *entry.table;
        scene::ParamSet p;
        float v = 0.2f;
        for (const model::Param& line : table.params)
            if (line.texturable && line.type == model::ParamType::color) {
                p.set(line.id,
                      table.type == "scale" ? scene::Value::color(v, v, v) : scene::Value::color(v, 0.5f, 1 - v));
                v += 0.25f;
            }
        if (table.mapped) {
            p.set("uscale", scene::Value::number(table.type == "bilerp" ? 1.f : 2.f));
            p.set("vdelta", scene::Value::number(0.125f));
        }
        if (table.find("x_from_x")) { // rotated, and finer than the scene's
            p.set("x_from_x", scene::Value::number(0));
            p.set("x_from_y", scene::Value::number(3));
            p.set("y_from_y", scene::Value::number(0));
            p.set("y_from_x", scene::Value::number(-3));
            p.set("origin_z", scene::Value::number(0.37f));
        }
        const float d = 4.f / float(side), x = -2 + d * float(at % side), y = -2 + d * float(at / side);
        w.instance(w.quad({x, y, 0}, {x + d, y, 0}, {x + d, y + d, 0}, {x, y + d, 0}),
                   w.paint(table.type, p, table.image ? image : scene::Id<scene::Image>{}));
        ++at;
    }
    const test::TemporaryFolder folder;
    const std::string file = (folder.path() / "out.pbrt").string();
    io::ExportOptions options;
    options.values.set("version", scene::Value::choice(version));
    const auto report = io::export_scene(w.scene, file, plugins().registry, options);
    if (!report) FAIL(report.error().message);
    for (const io::ReportEntry& e : report->entries)
        CHECK(e.fate == io::Fate::kept);
    auto again = io::import_scene(file, plugins().registry);
    if (!again) FAIL(again.error().message);
    const auto renderer = make_renderer("embree", {.strategy = render::Strategy::bsdf_only});
    const auto before = render_image(*renderer, w.scene, 16), after = render_image(*renderer, again->scene, 16);
    REQUIRE(before.color.size() == after.color.size());
    std::size_t other = 0; // an edge of a pattern may move by a rounding
    for (std::size_t i = 0; i < before.color.size(); ++i)
        other += glm::length(before.color[i] - after.color[i]) > 0.02f;
    CHECK(other * 50 < before.color.size());
    // And the picture depends on the texture
    glm::vec3 sum(0);
    for (const glm::vec3& c : before.color)
        sum += c;
    std::size_t off = 0;
    for (const glm::vec3& c : before.color)
        off += glm::length(c - sum / float(before.color.size())) > 0.1f;
    CHECK(off * 2 > before.color.size());
}

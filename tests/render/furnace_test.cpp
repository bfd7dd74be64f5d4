// SPDX-License-Identifier: Apache-2.0
// White furnaces: lossless objects are invisible in a constant white sky.
#include "render/checks.hpp"
#include "render/film_error.hpp"

#include <catch2/generators/catch_generators.hpp>
#include <map>

using namespace restage;
using namespace restage::tests;

namespace {

struct Furnace {
    SceneBuilder b;
    std::map<std::uint32_t, std::string> names; // by material id

    Furnace() {
        b.set_film(48, 32);
        b.set_camera({0, -14, 5}, {0, 0, 0}, {0, 0, 1}, 32);
        b.environment(glm::vec3(1));
        b.scene.settings.value.max_depth =
            1000; // light is caught in glass for long: at 100, 0.8 % of index 2.4 is missing
    }
    // A faceted sphere and a cube that touch, so that light passes between them.
    void add(const std::string& name, scene::Id<scene::Material> material) {
        static constexpr int columns = 5;
        if (!ball_) {
            ball_ = b.sphere(16, 32, false);
            box_ = cube(b);
        }
        const int i = int(names.size());
        const glm::dvec3 at(2.6 * (i % columns - 2), 2.8 * (i / columns) - 1.4, 0);
        b.instance(ball_, material, placed(at, 0.6));
        b.instance(box_, material,
                   glm::rotate(placed(at + glm::dvec3(0.95, 0.3, 0.1), 0.45), 0.7, glm::dvec3(0.3, 0.5, 1)));
        names[material.value] = name;
    }
    // The mean over the pixels of each material is `expected` within 3 standard errors.
    void check(const render::FilmImage& image) {
        for (const auto& [id, name] : names) {
            double sum = 0, variance = 0;
            std::size_t n = 0, off = 0;
            for (std::size_t i = 0; i < image.color.size(); ++i) {
                if (image.material_id[i] != id) continue;
                const double l = glm::dot(image.color[i], glm::vec3(0.2126f, 0.7152f, 0.0722f));
                // Corrected errors are right among pixels that are alike; here each is between others.
                off += std::abs(l - 1) > 3 * std::sqrt(render::independent_variance(image, i)) + 3e-4;
                sum += l;
                variance += image.luminance_variance[i];
                ++n;
            }
            REQUIRE(n > 20);
            const double error = std::sqrt(variance) / double(n);
            INFO(name << ": " << sum / double(n) << " +- " << error << ", " << off << " of " << n << " pixels off");
            CHECK(std::abs(sum / double(n) - 1) <= 3 * error + 2e-4);
            CHECK(error < 0.01);
            CHECK(double(off) <= 0.01 * double(n) + 1);
        }
    }

  private:
    scene::Id<scene::Mesh> ball_, box_;
};

} // namespace

TEST_CASE("furnace: every lossless material vanishes in a white sky") {
    const auto tracer = GENERATE("embree", "vulkan");
    const bool roulette = GENERATE(true, false);
    Furnace f;
    for (const auto& entry : plugins().registry.materials()) {
        const model::Material& table = *entry.table;
        if (!table.lossless) continue;
        int colors = 0;
        for (std::uint32_t i = 0; i < table.params.size(); ++i)
            colors += table.params[i].type == model::ParamType::color;
        scene::ParamSet p;
        const float v = table.additive ? 1.f / float(colors) : 1.f;
        for (std::uint32_t i = 0; i < table.params.size(); ++i)
            if (table.params[i].type == model::ParamType::color)
                p.set(table.params[i].id, scene::Value::color(v, v, v));
        f.add(table.type, f.b.material(table.type, p));
    }
    REQUIRE(f.names.size() >= 4);
    auto thin = numbers({{"eta", 1.5f}});
    thin.set("thin", scene::Value::boolean(true));
    f.add("thin dielectric", f.b.material("dielectric", thin));
    f.add("dielectric of index 2.4", f.b.material("dielectric", numbers({{"eta", 2.4f}})));
    auto white = numbers({{"uroughness", 0}, {"vroughness", 0}});
    white.set("use_reflectance", scene::Value::boolean(true));
    white.set("reflectance", scene::Value::color(1, 1, 1));
    f.add("smooth white conductor", f.b.material("conductor", white));
    f.b.scene.settings.value.russian_roulette = roulette;
    f.check(render_image(*make_renderer(tracer), f.b.scene, 64));
}

TEST_CASE("furnace: nearly smooth glass and metal lose almost nothing") {
    const auto tracer = GENERATE("embree", "vulkan");
    Furnace f;
    auto glass = numbers({{"uroughness", 0.01f}, {"vroughness", 0.01f}});
    glass.set("remap", scene::Value::choice("none"));
    f.add("glass of alpha 0.01", f.b.material("dielectric", glass));
    auto metal = glass;
    metal.set("use_reflectance", scene::Value::boolean(true));
    metal.set("reflectance", scene::Value::color(1, 1, 1));
    f.add("metal of alpha 0.01", f.b.material("conductor", metal));
    const auto image = render_image(*make_renderer(tracer), f.b.scene, 64);
    const Mean m = mean_luminance(image);
    INFO("mean " << m.value << " +- " << m.std_error);
    CHECK(m.value <= 1 + 3 * m.std_error);
    CHECK(m.value >= 0.998 - 3 * m.std_error); // masking at grazing angles absorbs a little
    CHECK(m.std_error < 0.002);
}

TEST_CASE("furnace: low-polygon spheres with shading normals neither glow nor go black at their silhouettes") {
    const auto tracer = GENERATE("embree", "vulkan");
    SceneBuilder b;
    b.set_film(60, 20);
    b.set_camera({0, -14, 0}, {0, 0, 0}, {0, 0, 1}, 10);
    b.environment(glm::vec3(1));
    b.scene.settings.value.max_depth = 20;
    const auto ball = b.sphere(10, 20);
    scene::ParamSet white;
    white.set("kr", scene::Value::color(1, 1, 1));
    const std::vector<std::pair<const char*, scene::Id<scene::Material>>> materials{
        {"diffuse", b.diffuse(1, 1, 1)}, {"mirror", b.material("mirror", white)}, {"glass", b.material("dielectric")}};
    for (std::size_t i = 0; i < materials.size(); ++i)
        b.instance(ball, materials[i].second,
                   glm::rotate(placed({2.4 * (double(i) - 1), 0, 0}), 0.4, glm::dvec3(1, 0.4, 0.2)));
    const auto image = render_image(*make_renderer(tracer), b.scene, 128);
    for (const auto& [name, id] : materials) {
        double sum = 0, least = 1e30;
        std::size_t n = 0;
        for (std::size_t i = 0; i < image.color.size(); ++i)
            if (image.material_id[i] == id.value) {
                sum += image.color[i].y;
                least = std::min(least, double(image.color[i].y));
                ++n;
            }
        REQUIRE(n > 100);
        INFO(name << ": mean " << sum / double(n) << ", least " << least);
        CHECK(std::abs(sum / double(n) - 1) < 0.02);
        CHECK(least > 0.5);
    }
}

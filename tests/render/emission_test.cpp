// SPDX-License-Identifier: Apache-2.0
// Materials that emit (restage/emission.h): like emitting objects, with textures, and through edits.
#include "paths.hpp"
#include "render/checks.hpp"

#include <catch2/generators/catch_generators.hpp>

using namespace restage;
using namespace restage::tests;

namespace {

// A lamp above a floor, both visible, in the dark.
struct Lamp : SceneBuilder {
    scene::Id<scene::Instance> lamp;
    Lamp() {
        set_camera({0, -6, 2.5}, {0, 0, 1}, {0, 0, 1}, 45);
        instance(quad({-8, -8, 0}, {8, -8, 0}, {8, 8, 0}, {-8, 8, 0}), diffuse(0.6f, 0.6f, 0.5f));
        glm::dmat4 m(1);
        m[3] = {0, 0, 2, 1};
        // downwards, and tilted towards the camera
        lamp = instance(quad({-1, -1, 0.3f}, {-1, 1, 0}, {1, 1, 0}, {1, -1, 0.3f}), diffuse(0, 0, 0), m);
    }
    scene::Id<scene::Material> emissive(const scene::Value& radiance, float scale, bool two_sided = false) {
        scene::ParamSet p;
        p.set("radiance", radiance);
        p.set("scale", scene::Value::number(scale));
        p.set("two_sided", scene::Value::boolean(two_sided));
        return material("emissive", p);
    }
    void give(scene::Id<scene::Material> m) {
        edit_instance(*this, lamp, [&](scene::Instance& i) { i.material = m; });
    }
    void flip() {
        edit_instance(*this, lamp, [](scene::Instance& i) { i.reverse_orientation = true; });
    }
    scene::Value textured(scene::Texture texture) {
        const auto id = scene.textures.next();
        scene.textures.set(id, std::move(texture), ++scene.clock);
        scene::Value v = scene::Value::color(1, 1, 1);
        v.texture = id;
        return v;
    }
    // White where floor(2 s) is even, that is for s < 1/2, black beyond.
    scene::Value half_white() {
        scene::Texture t{.name = "halves", .type = "checkerboard"};
        t.params = numbers({{"uscale", 2.f}, {"vscale", 1.f}, {"tex1", 1.f}, {"tex2", 0.f}});
        return textured(t);
    }
};

double worst_difference(const render::FilmImage& a, const render::FilmImage& b) {
    REQUIRE(a.color.size() == b.color.size());
    double worst = 0;
    for (std::size_t i = 0; i < a.color.size(); ++i)
        worst = std::max(worst, double(glm::length(a.color[i] - b.color[i])));
    return worst;
}

} // namespace

TEST_CASE("an emitting material gives the same light as an object's own emission") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const bool two_sided = GENERATE(false, true);
    Lamp own, by_material;
    edit_instance(own, own.lamp, [&](scene::Instance& i) {
        i.emission = scene::Emission{.radiance = {3, 2, 1.5f}, .two_sided = two_sided};
    });
    by_material.give(by_material.emissive(scene::Value::color(1, 2 / 3.f, 0.5f), 3, two_sided));
    const auto a = render_image(*make_renderer(tracer), own.scene, 32);
    const auto b = render_image(*make_renderer(tracer), by_material.scene, 32);
    CHECK(mean_luminance(a).value > 0.05);
    CHECK(worst_difference(a, b) < 1e-5);
}

TEST_CASE("a textured light is the same light to every strategy") {
    const std::string tracer = GENERATE("embree", "vulkan");
    const bool flipped = GENERATE(false, true);
    Lamp b;
    if (flipped) b.flip();
    b.give(b.emissive(b.half_white(), 5, true));
    const auto render = [&](render::Strategy strategy, std::uint32_t samples) {
        return render_image(*make_renderer(tracer, {.strategy = strategy}), b.scene, samples);
    };
    const auto mis = render(render::Strategy::mis, 64);
    check_same_mean(mis, render(render::Strategy::light_only, 64));
    check_same_mean(mis, render(render::Strategy::bsdf_only, 256));
    // half of the lamp's geometry, of one radiance
    Lamp half;
    if (flipped) half.flip();
    const auto mesh = half.quad({-1, -1, 0.3f}, {-1, 0, 0.15f}, {1, 0, 0.15f}, {1, -1, 0.3f});
    const auto rest = half.quad({-1, 0, 0.15f}, {-1, 1, 0}, {1, 1, 0}, {1, 0, 0.15f});
    auto dark = half.scene.instances[half.lamp];
    dark.mesh = rest;
    half.scene.instances.set(half.scene.instances.next(), dark, ++half.scene.clock);
    edit_instance(half, half.lamp, [&](scene::Instance& i) {
        i.mesh = mesh;
        i.emission = scene::Emission{.radiance = glm::vec3(5), .two_sided = true};
    });
    check_same_mean(mis, render_image(*make_renderer(tracer), half.scene, 64));
}

TEST_CASE("a screen shows its picture") {
    const std::string tracer = GENERATE("embree", "vulkan");
    SceneBuilder b;
    b.set_film(64, 64);
    // The quad fills the picture. pbrt's camera is left-handed: from above, x and with it s grow to the left.
    b.set_camera({0, 0, 10}, {0, 0, 0}, {0, 1, 0}, float(2 * std::atan(0.1) * 180 / std::numbers::pi));
    scene::Texture picture{.name = "picture", .type = "imagemap", .image = b.image(2, 1, 3, {1, 0, 0, 0, 0, 0.5f})};
    picture.params.set("wrap", scene::Value::choice("clamp"));
    const auto texture = b.scene.textures.next();
    b.scene.textures.set(texture, picture, ++b.scene.clock);
    scene::ParamSet p;
    scene::Value radiance = scene::Value::color(1, 1, 1);
    radiance.texture = texture;
    p.set("radiance", radiance);
    p.set("scale", scene::Value::number(4));
    b.instance(b.quad({-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}), b.material("emissive", p));
    const auto image = render_image(*make_renderer(tracer), b.scene, 16);
    const auto at = [&](int x) { return image.color[64 * 32 + std::size_t(x)]; };
    CHECK(glm::length(at(61) - glm::vec3(4, 0, 0)) < 1e-4);
    CHECK(glm::length(at(2) - glm::vec3(0, 0, 2)) < 1e-4);
}

TEST_CASE("a material's emission can be edited or overridden by the object, and is ignored in mixes") {
    const std::string tracer = GENERATE("embree", "vulkan");
    Lamp b;
    const auto bright = b.emissive(scene::Value::color(1, 1, 1), 2);
    b.give(bright);
    std::vector<std::string> warnings;
    Log log([&](LogLevel level, std::string_view line) {
        if (level == LogLevel::warning) warnings.emplace_back(line);
    });
    auto made = render::Renderer::create({.tracer = tracer, .shader_dir = restage::test::source_dir() / "shaders"},
                                         plugins().lookup(), log);
    REQUIRE(made);
    const auto& renderer = *made;
    const double one = mean_luminance(render_image(*renderer, b.scene, 16)).value;
    auto m = b.scene.materials[bright];
    m.params.set("scale", scene::Value::number(6));
    b.scene.materials.set(bright, m, ++b.scene.clock);
    const double three = mean_luminance(render_image(*renderer, b.scene, 16)).value;
    CHECK(std::abs(three - 3 * one) < 1e-4 * three);
    m.params.set("radiance", b.half_white());
    b.scene.materials.set(bright, m, ++b.scene.clock);
    const double half = mean_luminance(render_image(*renderer, b.scene, 64)).value;
    CHECK(half < 0.7 * three);
    CHECK(half > 0.3 * three);
    edit_instance(b, b.lamp, [](scene::Instance& i) { i.emission = scene::Emission{.radiance = glm::vec3(2)}; });
    CHECK(std::abs(mean_luminance(render_image(*renderer, b.scene, 16)).value - one) < 1e-4 * one);
    edit_instance(b, b.lamp, [](scene::Instance& i) { i.emission.reset(); });
    scene::ParamSet mixed = numbers({{"amount", 0.f}});
    scene::Value first{.type = model::ParamType::material};
    first.material = bright;
    mixed.set("first", first);
    mixed.set("second", first);
    b.give(b.material("mix", mixed));
    CHECK(warnings.empty());
    CHECK(mean_luminance(render_image(*renderer, b.scene, 4)).value == 0);
    CHECK(warnings ==
          std::vector<std::string>{"material \"mix\": its component \"emissive\" does not emit within a mix"});
}

// SPDX-License-Identifier: Apache-2.0
// Textures: the shader's evaluation equals the CPU's on random graphs, and both equal pbrt's definition in simple
// cases.
#include "render/fixture.hpp"
#include "render/gpu_scene.hpp"
#include "render/kernel_lab.hpp"
#include "render/scene_builder.hpp"
#include "render/texture_composer.hpp"

#include <random>

using namespace restage;
using namespace restage::tests;

namespace {

struct Ask {
    glm::vec4 uv; // both sets
    std::uint32_t texture;
};

class Textures {
  public:
    SceneBuilder b;

    scene::Id<scene::Texture> add(std::string type, scene::ParamSet params, scene::Id<scene::Image> image = {}) {
        const auto id = b.scene.textures.next();
        b.scene.textures.set(
            id, scene::Texture{.name = type, .type = std::move(type), .image = image, .params = std::move(params)},
            ++b.scene.clock);
        return id;
    }
    // By the shader.
    std::vector<glm::vec3> shade(const std::vector<Ask>& asks) {
        Jobs jobs(1);
        render::GpuScene scene(lab().device(), jobs, plugins().lookup());
        if (auto ok = scene.sync(b.scene); !ok) FAIL(ok.error().message);
        gpu::ShaderSource source;
        const std::string code = render::compose_textures(scene.texture_types(), source);
        return lab().run<glm::vec3, Ask>(
            code + "#include \"lib/texture.glsl\"\nstruct Ask { vec4 uv; uint id; };", "Ask", "vec3",
            "result = texture_data(SceneRef(root).scene, x.id, texture_at_uv(x.uv));", asks, scene.address(), source);
    }
    // By the CPU.
    std::vector<glm::vec3> evaluate(const std::vector<Ask>& asks) {
        render::TextureTypes types;
        const auto programs = render::compile_textures(b.scene, types, render::texture_lookup(plugins().registry));
        std::vector<render::CpuImage> images(b.scene.images.size() + 1);
        b.scene.images.each(
            [&](scene::Id<scene::Image> id, const scene::Image& i) { images[id.value].pixels = i.data.get(); });
        std::vector<glm::vec3> out;
        for (const auto& a : asks) {
            CHECK(programs.native[a.texture].there);
            out.push_back(render::evaluate_texture(programs, images, a.texture, a.uv));
        }
        return out;
    }
};

} // namespace

TEST_CASE("textures: shader and CPU agree on random graphs") {
    Textures t;
    std::mt19937 random(11);
    const auto unit = [&] { return std::uniform_real_distribution<float>(0, 1)(random); };
    std::vector<scene::Id<scene::Image>> images;
    for (const auto& [w, h, c] : {std::tuple{5u, 3u, 3u}, {1u, 1u, 1u}, {7u, 8u, 4u}, {16u, 2u, 1u}}) {
        std::vector<float> values(w * h * c);
        for (auto& v : values)
            v = unit() * 1.5f;
        images.push_back(t.b.image(w, h, c, std::move(values)));
    }
    const auto mapped = [&] {
        scene::ParamSet p;
        p.set("uscale", scene::Value::number(6 * unit() - 3));
        p.set("vscale", scene::Value::number(6 * unit() - 3));
        p.set("udelta", scene::Value::number(4 * unit() - 2));
        p.set("vdelta", scene::Value::number(4 * unit() - 2));
        if (random() % 3 == 0) p.set("ushear", scene::Value::number(4 * unit() - 2));
        if (random() % 3 == 0) p.set("vshear", scene::Value::number(4 * unit() - 2));
        if (random() % 3 == 0) p.set("uvset", scene::Value::integer(1));
        return p;
    };
    const auto color = [&] {
        return unit() < 0.5f ? scene::Value::number(unit()) : scene::Value::color(unit(), unit(), unit());
    };
    std::vector<scene::Id<scene::Texture>> all;
    const auto operand = [&] {
        scene::Value v = color();
        if (!all.empty() && unit() < 0.7f) v.texture = all[random() % all.size()];
        return v;
    };
    for (int i = 0; i < 120; ++i) {
        scene::ParamSet p = mapped();
        const auto kind = random() % (i < 12 ? 1 : 5);
        if (kind == 0) {
            p.set("wrap", scene::Value::choice(std::array{"repeat", "black", "clamp"}[random() % 3]));
            if (random() % 2) p.set("invert", scene::Value::boolean(true));
            if (random() % 2) p.set("scale", scene::Value::number(2 * unit()));
            all.push_back(t.add("imagemap", p, images[random() % images.size()]));
        } else if (kind == 1) {
            p.set("tex", operand());
            p.set("scale", operand());
            all.push_back(t.add("scale", p));
        } else if (kind == 2) {
            p.set("tex1", operand());
            p.set("tex2", operand());
            p.set("amount", operand());
            all.push_back(t.add("mix", p));
        } else if (kind == 3) {
            p.set("tex1", operand());
            p.set("tex2", operand());
            all.push_back(t.add("checkerboard", p));
        } else {
            p.set("value", operand());
            all.push_back(t.add("constant", p));
        }
    }
    std::vector<Ask> asks;
    for (const auto id : all)
        for (int k = 0; k < 60; ++k)
            asks.push_back({{5 * unit() - 2.5f, 5 * unit() - 2.5f, 5 * unit() - 2.5f, 5 * unit() - 2.5f}, id.value});
    const auto gpu = t.shade(asks), cpu = t.evaluate(asks);
    std::size_t wrong = 0, varied = 0;
    for (std::size_t i = 0; i < asks.size(); ++i) {
        // halves of values up to 1.5, scaled by up to 2, and wrapped coordinates in floats
        const bool off = glm::length(gpu[i] - cpu[i]) > 2e-3f + 2e-3f * glm::length(cpu[i]);
        if (off && ++wrong < 6)
            UNSCOPED_INFO("texture " << asks[i].texture << " "
                                     << t.b.scene.textures[scene::Id<scene::Texture>{asks[i].texture}].type << " at "
                                     << asks[i].uv.x << ", " << asks[i].uv.y << ": " << gpu[i].x << ' ' << gpu[i].y
                                     << ' ' << gpu[i].z << ", CPU " << cpu[i].x << ' ' << cpu[i].y << ' ' << cpu[i].z);
        varied += glm::length(cpu[i] - cpu[i ? i - 1 : 0]) > 0.01f;
    }
    CHECK(wrong <= 2); // a sample may fall on the edge of a check
    CHECK(varied > asks.size() / 4); // else the graphs are constants
}

TEST_CASE("textures: pbrt's conventions") {
    Textures t;
    const std::uint32_t w = 4, h = 3;
    std::vector<float> values;
    for (std::uint32_t i = 0; i < w * h; ++i)
        values.push_back(float(i));
    const auto image = t.b.image(w, h, 1, values);
    const auto wrapped = [&](const char* mode) {
        scene::ParamSet p;
        p.set("wrap", scene::Value::choice(mode));
        return t.add("imagemap", p, image).value;
    };
    const auto repeat = wrapped("repeat"), black = wrapped("black"), clamp = wrapped("clamp");
    scene::ParamSet p;
    p.set("tex1", scene::Value::number(1));
    p.set("tex2", scene::Value::number(2));
    p.set("uscale", scene::Value::number(2));
    p.set("vscale", scene::Value::number(2));
    const auto checks = t.add("checkerboard", p).value;
    std::vector<Ask> asks;
    std::vector<float> expected;
    for (int y = -3; y < 6; ++y) // texel centres, row 0 at t = 1; also outside
        for (int x = -4; x < 8; ++x) {
            const glm::vec2 uv((float(x) + 0.5f) / float(w), 1 - (float(y) + 0.5f) / float(h));
            const bool inside = x >= 0 && x < 4 && y >= 0 && y < 3;
            const auto at = [&](int a, int b) { return values[std::size_t(b) * w + std::size_t(a)]; };
            asks.push_back({glm::vec4(uv, uv), repeat});
            expected.push_back(at((x + 4) % 4, (y + 3) % 3));
            asks.push_back({glm::vec4(uv, uv), black});
            expected.push_back(inside ? at(x, y) : 0);
            asks.push_back({glm::vec4(uv, uv), clamp});
            expected.push_back(at(std::clamp(x, 0, 3), std::clamp(y, 0, 2)));
        }
    for (const auto& [u, v, value] :
         {std::tuple{0.1f, 0.1f, 1.f}, {0.6f, 0.1f, 2.f}, {0.6f, 0.6f, 1.f}, {-0.1f, 0.1f, 2.f}, {-0.1f, -0.1f, 1.f}}) {
        asks.push_back({{u, v, u, v}, checks});
        expected.push_back(value);
    }
    asks.push_back({{0.5f, 1 - 0.5f / 3, 0, 0}, repeat}); // half way between two texels
    expected.push_back(1.5f);
    const auto gpu = t.shade(asks), cpu = t.evaluate(asks);
    for (std::size_t i = 0; i < asks.size(); ++i) {
        INFO("texture " << asks[i].texture << " at " << asks[i].uv.x << ", " << asks[i].uv.y);
        CHECK(std::abs(gpu[i].x - expected[i]) < 1e-3f);
        CHECK(std::abs(cpu[i].x - expected[i]) < 1e-3f);
    }
}

TEST_CASE("textures: every shipped one compiles, in both colour modes") {
    const auto judge = render::texture_judge(restage::test::source_dir() / "shaders");
    const gpu::ShaderCompiler compiler({.include_dirs = {restage::test::source_dir() / "shaders"}, .cache_dir = {}});
    const auto all = plugins().registry.textures();
    CHECK(all.size() >= 11);
    for (const plugin::TextureEntry& t : all) {
        INFO(t.table->type);
        const auto rgb = judge(t);
        CHECK((rgb ? "" : rgb.error().message) == "");
        const render::TextureType type{t.table->type, {t.table, t.plugin->folder, t.source, t.blame}};
        gpu::ShaderSource source{.name = "spectral", .text = R"(#version 460
#extension GL_GOOGLE_include_directive : require
#define RESTAGE_SPECTRAL 1
#include "lib/extensions.glsl"
layout(local_size_x = 64) in;
void main() {}
)"};
        render::insert_textures({&type, 1}, source);
        const auto spectral = compiler.compile(source);
        CHECK((spectral ? "" : spectral.error().message) == "");
    }
}

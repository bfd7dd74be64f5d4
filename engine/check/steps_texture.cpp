// SPDX-License-Identifier: Apache-2.0
// Textures: their GLSL, on the device, at a list of places, with random parameters; and their native code on the
// same input.
#include "check/steps.hpp"

#include "render/texture_composer.hpp"
#include "render/texture_program.hpp"

#include <fmt/format.h>
#include <bit>
#include <cmath>
#include <cstdint>

namespace restage::check {

namespace {

struct Place { // as in the kernel
    glm::vec4 uv;
    glm::vec3 position;
    float footprint;
    std::uint32_t texture;
};

constexpr const char* kernel = R"(#version 460
#extension GL_GOOGLE_include_directive : require
{}#include "lib/extensions.glsl"
layout(local_size_x = 64) in;
struct Place {{ vec4 uv; vec3 position; float footprint; uint texture_id; }};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Places {{ Place at[]; }};
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Values {{ vec3 at[]; }};
layout(push_constant, scalar) uniform Push {{ uint64_t scene, places, values; uint count, pad; }} push;
void main() {{
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) return;
    Place x = Places(push.places).at[i];
    TextureAt at = texture_at_uv(x.uv);
#ifdef RESTAGE_TEXTURE_SITES
    at.place.position = at.place.world = x.position;
    at.place.footprint = x.footprint;
    at.place.dp_dx = at.place.dp_dy = vec3(x.footprint, 0, 0);
#endif
    Values(push.values).at[i] = texture_data(SceneRef(push.scene).scene, x.texture_id, at);
}}
)";
struct Push {
    std::uint64_t scene = 0, places = 0, values = 0;
    std::uint32_t count = 0, pad = 0;
};

render::TextureType type_of(const Subject& s) {
    const plugin::TextureEntry& t = *s.texture;
    return {t.table->type, {t.table, t.plugin->folder, t.source, t.blame}};
}

Result<gpu::Spirv> compile(Subject& s, bool spectral = false) {
    gpu::ShaderSource source{.name = "<composed for " + s.texture->table->type + ">",
                             .text = fmt::format(kernel, spectral ? "#define RESTAGE_SPECTRAL 1\n" : "")};
    const render::TextureType type = type_of(s);
    render::insert_textures({&type, 1}, source);
    RESTAGE_TRY(const gpu::ShaderCompiler* const compiler, s.compiler());
    return compiler->compile(source);
}

// A scene of textures of the type, one per configuration, with an image if the type samples one.
scene::Scene scene_of(const model::Texture& table, const std::vector<scene::ParamSet>& configs) {
    scene::Scene out;
    scene::Id<scene::Image> image;
    if (table.image) {
        auto data = std::make_shared<scene::PixelData>();
        *data = {.width = 4, .height = 3, .channels = 3, .values = {}};
        for (int i = 0; i < 36; ++i)
            data->values.push_back(float(i * 7 % 36) / 35);
        image = out.images.next();
        out.images.set(image, scene::Image{.name = "image", .data = std::move(data)}, ++out.clock);
    }
    for (const scene::ParamSet& set : configs)
        out.textures.set(out.textures.next(),
                         scene::Texture{.name = "t", .type = table.type, .image = image, .params = set}, ++out.clock);
    return out;
}

struct Answers {
    std::vector<glm::vec3> device;
    std::vector<glm::vec3> native; // empty: no native code
};

Result<Answers> ask(Subject& s, const std::vector<scene::ParamSet>& configs, const std::vector<Place>& places) {
    const model::Texture& table = *s.texture->table;
    const scene::Scene scene = scene_of(table, configs);
    render::TextureTypes types{type_of(s)};
    const auto programs = render::compile_textures(scene, types, {});
    RESTAGE_TRY(gpu::Device* const device, s.device());
    RESTAGE_TRY(const gpu::Spirv spirv, compile(s));
    RESTAGE_TRY(const auto pipeline, gpu::ComputePipeline::create(*device, spirv, sizeof(Push), {}, "texture lab"));
    const auto buffer = [&]<class T>(const std::vector<T>& v) { // never empty
        std::vector<T> padded = v;
        padded.resize(v.size() + 1);
        return device->create_buffer_of<T>(padded, "texture lab");
    };
    std::vector<glm::vec4> texels;
    std::vector<render::CpuImage> images(2);
    if (const auto* image = scene.images.find({1})) {
        images[1].pixels = image->data.get();
        for (std::size_t i = 0; i < image->data->values.size(); i += 3)
            texels.emplace_back(image->data->values[i], image->data->values[i + 1], image->data->values[i + 2], 1);
    }
    RESTAGE_TRY(const gpu::Buffer texel_buffer, buffer(texels));
    const std::vector<shared::ImageData> records{{}, {texel_buffer.address(), 4, 3, TEXEL_FLOAT4, 0}};
    RESTAGE_TRY(const gpu::Buffer image_buffer, buffer(records));
    RESTAGE_TRY(const gpu::Buffer program_buffer, buffer(programs.programs));
    RESTAGE_TRY(const gpu::Buffer word_buffer, buffer(programs.words));
    RESTAGE_TRY(const gpu::Buffer place_buffer, buffer(places));
    shared::SceneData root{};
    root.textures = program_buffer.address();
    root.texture_words = word_buffer.address();
    root.images = image_buffer.address();
    RESTAGE_TRY(const gpu::Buffer root_buffer, buffer(std::vector<shared::SceneData>{root}));
    RESTAGE_TRY(gpu::Buffer values,
                device->create_buffer(places.size() * sizeof(glm::vec3), gpu::BufferKind::readback, "texture values"));
    const Push push{root_buffer.address(), place_buffer.address(), values.address(), std::uint32_t(places.size()), 0};
    RESTAGE_TRY(gpu::CommandList list, device->begin());
    list.dispatch(pipeline, gpu::push_bytes(push), std::uint32_t((places.size() + 63) / 64));
    RESTAGE_CHECK(device->submit_and_wait(list));
    s.alive();
    Answers out;
    const auto read = values.span<glm::vec3>();
    out.device.assign(read.begin(), read.begin() + std::ptrdiff_t(places.size()));
    if (s.texture->source->eval())
        for (const Place& p : places)
            out.native.push_back(render::evaluate_texture(programs, images, p.texture, p.uv));
    return out;
}

std::vector<scene::ParamSet> random_configs(const Subject& s, Engine& e, std::size_t count) {
    model::Material as_material; // the same table
    as_material.params = s.texture->table->params;
    std::vector<scene::ParamSet> out{{}};
    while (out.size() < count && !as_material.params.empty())
        out.push_back(random_config(as_material, e));
    for (std::size_t i = 1; s.texture->table->mapped && i < out.size(); ++i) {
        out[i].set("uscale", scene::Value::number(uniform(e, -4, 4)));
        out[i].set("vdelta", scene::Value::number(uniform(e, -4, 4)));
    }
    return out;
}

// The same places for each configuration. The first are corners and the origin.
std::vector<Place> places_for(Engine& e, std::size_t configs, std::size_t each) {
    std::vector<Place> one;
    for (std::size_t i = 0; i < each; ++i) {
        const float far = i % 8 == 7 ? 1000.f : 3.f;
        Place p{{uniform(e, -far, far), uniform(e, -far, far), 0, 0},
                {uniform(e, -far, far), uniform(e, -far, far), uniform(e, -far, far)},
                std::exp(uniform(e, -12, 3)),
                0};
        if (i == 0) p.uv = glm::vec4(0), p.position = glm::vec3(0), p.footprint = 0;
        if (i == 1) p.uv = glm::vec4(1), p.position = glm::vec3(1);
        p.uv.z = p.uv.x, p.uv.w = p.uv.y;
        one.push_back(p);
    }
    std::vector<Place> all;
    for (std::size_t c = 0; c < configs; ++c)
        for (Place p : one) {
            p.texture = std::uint32_t(c + 1);
            all.push_back(p);
        }
    return all;
}

std::string text(const glm::vec3& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z); }
std::string at(const Place& p, const scene::ParamSet& config) {
    return fmt::format("uv ({:.6g}, {:.6g}), position {}, a footprint of {:.3g}, {}", p.uv.x, p.uv.y, text(p.position),
                       p.footprint, describe(config));
}
bool same(const glm::vec3& a, const glm::vec3& b) { // to the bit
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x); };
    return bits(a.x) == bits(b.x) && bits(a.y) == bits(b.y) && bits(a.z) == bits(b.z);
}

constexpr std::size_t places_each = 256;

} // namespace

Result<StepResult> check_texture_glsl(Subject& s) {
    RESTAGE_TRY(const gpu::Spirv spirv, compile(s));
    if (const auto spectral = compile(s, true); !spectral)
        return StepResult::failed(spectral.error().message +
                                  "\nin spectral mode, where a colour has four components: use Spectrum and "
                                  "texture_color(), not vec3 or .rgb (restage/v1/texture.glsl)");
    return StepResult::passed({{"code", static_cast<double>(spirv.words.size() * 4), "bytes of SPIR-V"}});
}

Result<StepResult> check_texture_names(Subject& s) {
    RESTAGE_TRY(const gpu::Spirv spirv, compile(s));
    return check_names_in(s, spirv, s.texture->table->prefix, s.texture->table->glsl_file);
}

Result<StepResult> check_texture_values(Subject& s) {
    Engine e = s.random("texture-values");
    const auto configs = random_configs(s, e, s.size(64, 16));
    const auto places = places_for(e, configs.size(), places_each);
    RESTAGE_TRY(const Answers first, ask(s, configs, places));
    RESTAGE_TRY(const Answers second, ask(s, configs, places));
    float least = 1e30f, most = -1e30f;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const glm::vec3& v = first.device[i];
        const std::string where = at(places[i], configs[places[i].texture - 1]);
        for (int k = 0; k < 3; ++k) {
            if (!std::isfinite(v[k])) return StepResult::failed("it is " + text(v) + " at " + where);
            least = std::min(least, v[k]), most = std::max(most, v[k]);
        }
        if (!same(v, second.device[i]))
            return StepResult::failed("it is " + text(v) + ", and on the second run " + text(second.device[i]) +
                                      " at " + where);
    }
    return StepResult::passed({{"least", least}, {"most", most}});
}

Result<StepResult> check_texture_params(Subject& s) {
    const model::Texture& table = *s.texture->table;
    Engine e = s.random("texture-params");
    std::size_t seen = 0;
    for (const model::Param& line : table.params) {
        if (line.type == model::ParamType::text) continue;
        auto configs = random_configs(s, e, 17);
        std::vector<scene::ParamSet> pairs;
        // Two that differ in this line only: its ends; from the fourth on its default and values ever closer to it, as
        // far from it a pattern may be constant to the last bit.
        for (std::size_t k = 0; k < configs.size(); ++k)
            for (const bool upper : {false, true}) {
                scene::ParamSet set = k % 2 ? scene::ParamSet() : configs[k]; // the others: defaults, or random
                const auto pick = [&](float least, float most, float usual) {
                    if (k < 3) return upper ? most : least;
                    const float end = k % 2 ? most : least;
                    return upper ? usual + (end - usual) * std::pow(10.f, -float(k % 7)) : usual;
                };
                switch (line.type) {
                    case model::ParamType::number:
                        set.set(line.id, scene::Value::number(pick(line.min, line.max, line.def[0])));
                        break;
                    case model::ParamType::color: {
                        const float v = pick(line.min, line.max, line.def[0]);
                        set.set(line.id, scene::Value::color(v, v, v));
                        break;
                    }
                    case model::ParamType::integer:
                        set.set(line.id, scene::Value::integer(upper ? line.int_max : line.int_min));
                        break;
                    case model::ParamType::boolean:
                        set.set(line.id, scene::Value::boolean(upper));
                        break;
                    default:
                        set.set(line.id, scene::Value::choice(line.choices[upper ? line.choices.size() - 1 : 0]));
                }
                pairs.push_back(std::move(set));
            }
        const auto places = places_for(e, pairs.size(), places_each);
        RESTAGE_TRY(const Answers answers, ask(s, pairs, places));
        bool differs = line.type == model::ParamType::choice && line.choices.size() == 1;
        for (std::size_t c = 0; c < pairs.size() && !differs; c += 2)
            for (std::size_t i = 0; i < places_each && !differs; ++i)
                differs = !same(answers.device[c * places_each + i], answers.device[(c + 1) * places_each + i]);
        if (!differs) return StepResult::failed(fmt::format("\"{}\" has no effect anywhere in its range", line.id));
        ++seen;
    }
    return StepResult::passed({{"parameters", static_cast<double>(seen)}});
}

Result<StepResult> check_texture_native(Subject& s) {
    if (!s.texture->source->eval()) return StepResult::skip("has no native evaluation");
    Engine e = s.random("texture-native");
    const auto configs = random_configs(s, e, s.size(64, 16));
    const auto places = places_for(e, configs.size(), places_each);
    s.doing("eval()");
    RESTAGE_TRY(const Answers answers, ask(s, configs, places));
    std::size_t off = 0, worst = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const glm::vec3 &a = answers.device[i], &b = answers.native[i];
        if (glm::length(a - b) <= 1e-3f + 1e-3f * glm::length(a)) continue;
        ++off, worst = i;
    }
    // At the edge of a pattern rounding decides.
    if (off > places.size() / 200)
        return StepResult::failed(fmt::format("at {} of {} places it differs from the GLSL: {} instead of {} at {}",
                                              off, places.size(), text(answers.native[worst]),
                                              text(answers.device[worst]),
                                              at(places[worst], configs[places[worst].texture - 1])));
    return StepResult::passed({{"other values", static_cast<double>(off)}});
}

} // namespace restage::check

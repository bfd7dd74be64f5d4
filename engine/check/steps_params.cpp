// SPDX-License-Identifier: Apache-2.0
// Values keep what they are on their way: from a ParamSet through the packed words into the struct that the GLSL sees,
// and through a project file and back.
#include "check/steps.hpp"

#include "base/file.hpp"
#include "render/material_composer.hpp"
#include "scene/edits.hpp"
#include "session/project.hpp"

#include <fmt/format.h>
#include <bit>
#include <cmath>
#include <random>

namespace restage::check {

using scene::ParamSet;

namespace {

std::string placed(std::string text, const std::string& id) { // "m.$" becomes "m.id"
    for (std::size_t at; (at = text.find('$')) != std::string::npos;)
        text.replace(at, 1, id);
    return text;
}

// One expression a word, in the order of the table.
std::vector<std::pair<std::string, std::string>> words_of(const RestageMaterial1& table) { // GLSL, name for people
    std::vector<std::pair<std::string, std::string>> words;
    for (std::uint32_t i = 0; i < table.param_count; ++i) {
        const RestageParam& p = table.params[i];
        const std::string id = p.id;
        if (p.type == RESTAGE_FLOAT) words.emplace_back("floatBitsToUint(m." + id + ")", id);
        if (p.type == RESTAGE_COLOR)
            for (const char* c : {".x", ".y", ".z"})
                words.emplace_back("floatBitsToUint(m." + id + c + ")", id + c);
        if (p.type == RESTAGE_INT || p.type == RESTAGE_ENUM || p.type == RESTAGE_BOOL)
            words.emplace_back("uint(m." + id + ")", id);
        if (p.type == RESTAGE_TABLE)
            for (const char* at : {"0u", "table_size(m.$) - 1u", "table_size(m.$)"}) {
                std::string word = std::string("table_word(m.$, ") + at + ")", size = "table_size(m.$)";
                if (std::string_view(at) == "0u") words.emplace_back(placed(size, id), id + ", its size");
                words.emplace_back(placed(word, id), id + ", its word at " + at);
            }
    }
    return words;
}

// What the GLSL must see, from the set itself and not from how it is packed.
Result<std::vector<std::uint32_t>> expected_words(const Subject& s, const ParamSet& set) {
    const RestageMaterial1& table = s.table();
    std::vector<std::uint32_t> words;
    for (std::uint32_t i = 0; i < table.param_count; ++i) {
        const RestageParam& p = table.params[i];
        const scene::Value* v = set.find(p.id);
        const float first = v ? v->v[0] : p.def[0];
        if (p.type == RESTAGE_FLOAT) words.push_back(std::bit_cast<std::uint32_t>(first));
        if (p.type == RESTAGE_COLOR)
            for (std::size_t c = 0; c < 3; ++c)
                words.push_back(std::bit_cast<std::uint32_t>(v ? v->v[c] : p.def[c]));
        if (p.type == RESTAGE_INT) words.push_back(static_cast<std::uint32_t>(static_cast<int>(std::lround(first))));
        if (p.type == RESTAGE_BOOL) words.push_back(first != 0);
        if (p.type == RESTAGE_ENUM) {
            std::uint32_t index = static_cast<std::uint32_t>(p.def[0]);
            for (std::size_t k = 0; v && k < choices(p); ++k)
                if (choice(p, k) == v->text) index = static_cast<std::uint32_t>(k);
            words.push_back(index);
        }
        if (p.type == RESTAGE_TABLE) {
            RESTAGE_TRY(const auto read, s.material().source->table_reader()->read(p.id, render::table_path(p, set)));
            const auto& in = read->words;
            words.push_back(static_cast<std::uint32_t>(in.size()));
            words.push_back(in.empty() ? 0 : in.front());
            words.push_back(in.empty() ? 0 : in.back());
            words.push_back(0); // past its end
        }
    }
    return words;
}

struct Push {
    std::uint64_t params, out;
};

Result<StepResult> through_glsl(Subject& s, const std::vector<ParamSet>& sets) {
    const auto words = words_of(s.table());
    std::string main =
        "layout(local_size_x = 1) in;\n"
        "layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Out { uint at[]; };\n"
        "layout(push_constant, scalar) uniform Push { uint64_t params, answer; } push;\n"
        "void main() {\n    SceneData scene;\n    scene.params = push.params;\n"
        "    Material m = material_fetch(scene, 0u, vec2(0));\n    Out o = Out(push.answer);\n"
        "    o.at[0] = 0u;\n";
    for (std::size_t i = 0; i < words.size(); ++i)
        main += fmt::format("    o.at[{}] = {};\n", i, words[i].first);
    RESTAGE_TRY(gpu::Device* const device, s.device());
    RESTAGE_TRY(gpu::ShaderCompiler* const compiler, s.compiler());
    render::MaterialType type;
    type.type = s.table().type;
    type.plugin = s.material();
    gpu::ShaderSource source = render::compose_material(type, "check_params.glsl", gpu::ShaderStage::compute);
    source.files["check_params.glsl"] = main + "}\n";
    RESTAGE_TRY(const gpu::Spirv spirv, compiler->compile(source));
    const auto constants = render::spec_constants({}, false, render::Strategy::mis, &type);
    RESTAGE_TRY(const gpu::ComputePipeline pipeline,
                gpu::ComputePipeline::create(*device, spirv, sizeof(Push), constants, "check params"));
    RESTAGE_TRY(gpu::Buffer out,
                device->create_buffer((words.size() + 4) * 4, gpu::BufferKind::readback, "check params answer"));
    render::TableStore tables(*device);
    for (const ParamSet& set : sets) {
        RESTAGE_TRY(const auto found, tables.find(type.plugin, set));
        std::vector<std::uint32_t> packed = render::pack_material(s.table(), set, found);
        packed.resize(packed.size() + 4);
        RESTAGE_TRY(const gpu::Buffer in, device->create_buffer_of<std::uint32_t>(packed, "check params words"));
        const Push push{in.address(), out.address()};
        RESTAGE_TRY(gpu::CommandList commands, device->begin());
        commands.dispatch(pipeline, gpu::push_bytes(push), 1);
        RESTAGE_CHECK(device->submit_and_wait(commands));
        RESTAGE_TRY(const auto expected, expected_words(s, set));
        for (std::size_t i = 0; i < words.size(); ++i)
            if (out.span<std::uint32_t>()[i] != expected[i])
                return StepResult::failed(fmt::format("{} arrives in the GLSL as 0x{:08x}, not as 0x{:08x}\n  with {}",
                                                      words[i].second, out.span<std::uint32_t>()[i], expected[i],
                                                      describe(set)));
        s.alive();
    }
    return StepResult::passed({});
}

Result<StepResult> through_project(Subject& s, const std::vector<ParamSet>& sets) {
    scene::Scene scene;
    for (const ParamSet& set : sets) {
        scene::Material m;
        m.name = fmt::format("material {}", scene.materials.size());
        m.type = s.table().type, m.params = set;
        scene::apply(scene, scene::insert(scene, std::move(m), "check"));
    }
    const session::Base base;
    const session::DataSources sources;
    std::error_code code;
    const auto file =
        std::filesystem::temp_directory_path(code) / fmt::format("restage-check-{}.restage", std::random_device{}());
    RESTAGE_CHECK(write_file_atomic(
        file, session::project_text({.base = base, .scene = scene, .sources = sources}, file.parent_path())));
    auto document = session::read_project(file.string(), s.registry());
    std::filesystem::remove(file, code);
    if (!document) return fail("a project with this material is not read back", document.error());
    scene::Scene back = document->base.scene;
    scene::apply(back, document->changes);
    std::size_t compared = 0;
    std::string text;
    scene.materials.each([&](auto id, const scene::Material& m) {
        const scene::Material* other = back.materials.find(id);
        if (other && other->params == m.params && other->type == m.type)
            ++compared;
        else if (text.empty())
            text = fmt::format("a project file gives back {}\n  for {}", other ? describe(other->params) : "nothing",
                               describe(m.params));
    });
    return text.empty() ? StepResult::passed({}) : StepResult::failed(text);
}

} // namespace

Result<StepResult> check_params(Subject& s) {
    if (s.table().param_count == 0) return StepResult::skip("has no parameters");
    Engine e = s.random("params");
    std::vector<ParamSet> sets{{}};
    while (sets.size() < s.size(200, 50))
        sets.push_back(random_config(s.table(), e));
    const bool glsl = !s.is(RESTAGE_MATERIAL_MIX | RESTAGE_MATERIAL_NULL);
    if (glsl) {
        RESTAGE_TRY(StepResult seen, through_glsl(s, sets));
        if (seen.verdict != Verdict::pass) return seen;
    }
    RESTAGE_TRY(StepResult kept, through_project(s, sets));
    if (kept.verdict != Verdict::pass) return kept;
    return StepResult::passed({{"parameters", double(s.table().param_count)}, {"sets", double(sets.size())}});
}

} // namespace restage::check

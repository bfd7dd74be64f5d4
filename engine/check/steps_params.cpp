// SPDX-License-Identifier: Apache-2.0
// Values are preserved in transit: from a ParamSet through the packed words into the GLSL struct,
// and through a project file and a pbrt file and back.
#include "check/steps.hpp"
#include "check/workplace.hpp"

#include "base/file.hpp"
#include "document/project.hpp"
#include "io/export.hpp"
#include "io/import.hpp"
#include "io/services.hpp"
#include "render/material_composer.hpp"
#include "scene/edits.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

namespace restage::check {

using scene::ParamSet;

namespace {

std::string placed(std::string text, const std::string& id) { // "m.$" becomes "m.id"
    for (std::size_t at; (at = text.find('$')) != std::string::npos;)
        text.replace(at, 1, id);
    return text;
}

// One expression per word, in table order.
std::vector<std::pair<std::string, std::string>> words_of(const model::Material& table) { // GLSL, display name
    std::vector<std::pair<std::string, std::string>> words;
    for (std::uint32_t i = 0; i < table.params.size(); ++i) {
        const model::Param& p = table.params[i];
        const std::string id = p.id;
        if (p.type == model::ParamType::number) words.emplace_back("floatBitsToUint(m." + id + ")", id);
        if (p.type == model::ParamType::color)
            for (const char* c : {".x", ".y", ".z"})
                words.emplace_back("floatBitsToUint(m." + id + c + ")", id + c);
        if (p.type == model::ParamType::integer || p.type == model::ParamType::choice ||
            p.type == model::ParamType::boolean)
            words.emplace_back("uint(m." + id + ")", id);
        if (p.type == model::ParamType::table)
            for (const char* at : {"0u", "table_size(m.$) - 1u", "table_size(m.$)"}) {
                std::string word = std::string("table_word(m.$, ") + at + ")", size = "table_size(m.$)";
                if (std::string_view(at) == "0u") words.emplace_back(placed(size, id), id + ", its size");
                words.emplace_back(placed(word, id), id + ", its word at " + at);
            }
    }
    return words;
}

// The values expected in the GLSL, from the set itself, independent of packing.
Result<std::vector<std::uint32_t>> expected_words(const Subject& s, const ParamSet& set) {
    const model::Material& table = s.table();
    std::vector<std::uint32_t> words;
    for (std::uint32_t i = 0; i < table.params.size(); ++i) {
        const model::Param& p = table.params[i];
        const scene::Value* v = set.find(p.id);
        const scene::Value first = v ? *v : scene::default_value(p);
        if (p.type == model::ParamType::number) words.push_back(std::bit_cast<std::uint32_t>(first.scalar()));
        if (p.type == model::ParamType::color)
            for (std::size_t c = 0; c < 3; ++c)
                words.push_back(std::bit_cast<std::uint32_t>(v ? v->v[c] : p.def[c]));
        if (p.type == model::ParamType::integer) words.push_back(static_cast<std::uint32_t>(first.whole()));
        if (p.type == model::ParamType::boolean) words.push_back(first.whole() != 0);
        if (p.type == model::ParamType::choice) {
            std::uint32_t index = static_cast<std::uint32_t>(p.int_def);
            for (std::size_t k = 0; v && k < choices(p); ++k)
                if (choice(p, k) == v->text) index = static_cast<std::uint32_t>(k);
            words.push_back(index);
        }
        if (p.type == model::ParamType::table) {
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
        "    Material whole = material_fetch(scene, 0u, texture_at_uv(vec4(0)));\n    Out o = Out(push.answer);\n"
        "    o.at[0] = 0u;\n";
    main += fmt::format("    {}_Params m = {};\n", s.table().prefix, s.table().site ? "whole.params" : "whole");
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

// One material per set, each on a triangle: pbrt drops unused materials.
scene::Scene scene_of(const model::Material& table, const std::vector<ParamSet>& sets) {
    scene::Scene scene;
    scene::apply(scene, scene::insert(scene, scene::Camera{}, "check"));
    scene.active_camera.value = {1};
    auto data = std::make_shared<scene::MeshData>();
    data->positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    data->triangles = {{0, 1, 2}};
    data->upper = {1, 1, 0};
    const auto mesh = scene.meshes.next();
    scene::apply(scene, scene::insert(scene, scene::Mesh{.name = "triangle", .data = data}, "check"));
    for (const ParamSet& set : sets) {
        const auto id = scene.materials.next();
        scene::Material m;
        m.name = fmt::format("material {}", scene.materials.size());
        m.type = table.type, m.params = set;
        scene::apply(scene, scene::insert(scene, std::move(m), "check"));
        scene::apply(scene, scene::insert(scene, scene::Instance{.mesh = mesh, .material = id}, "check"));
    }
    return scene;
}

Result<StepResult> through_project(Subject& s, const scene::Scene& scene) {
    const document::Base base;
    const document::DataSources sources;
    const TemporaryFolder folder;
    const auto file = folder.path / "check.restage";
    RESTAGE_CHECK(write_file_atomic(
        file, document::project_text({.base = base, .scene = scene, .sources = sources}, file.parent_path())));
    auto document = document::read_project(file.string(), s.registry());
    if (!document) return fail("a project with this material is not read back", document.error());
    scene::Scene back = document->base.scene;
    scene::apply(back, document->changes);
    std::string text;
    scene.materials.each([&](auto id, const scene::Material& m) {
        const scene::Material* other = back.materials.find(id);
        if ((!other || other->params != m.params || other->type != m.type) && text.empty())
            text = fmt::format("a project file returns {}\n  for {}", other ? describe(other->params) : "nothing",
                               describe(m.params));
    });
    return text.empty() ? StepResult::passed({}) : StepResult::failed(text);
}

// Whether both are equal, with defaults filled in. Decimal values from the file may differ in the last bit.
bool same_values(const model::Material& table, const ParamSet& a, const ParamSet& b) {
    for (std::uint32_t i = 0; i < table.params.size(); ++i) {
        const model::Param& p = table.params[i];
        if (p.type > model::ParamType::choice) continue; // neither texts nor references
        const scene::Value *x = a.find(p.id), *y = b.find(p.id);
        if (p.type == model::ParamType::choice) {
            const std::string otherwise = choice(p, static_cast<std::size_t>(p.int_def));
            if ((x ? x->text : otherwise) != (y ? y->text : otherwise)) return false;
            continue;
        }
        for (std::size_t c = 0; c < (p.type == model::ParamType::color ? 3u : 1u); ++c) {
            const auto at = [&](const scene::Value* set) {
                const scene::Value held = set ? *set : scene::default_value(p);
                return c == 0 ? held.scalar() : held.v[c];
            };
            const float u = at(x), v = at(y);
            if (std::abs(u - v) > 1e-6f * std::max(std::abs(u), std::abs(v))) return false;
        }
    }
    return true;
}

// The largest relative difference of f; for stochastic materials, whose walks may diverge by rounding, the median.
Result<double> difference(Subject& s, const ParamSet& a, const ParamSet& b, Engine& e) {
    RESTAGE_TRY(BsdfLab* const lab, s.lab());
    std::vector<BsdfJob> jobs;
    for (std::uint32_t i = 0; i < 64; ++i) {
        const Vec3 wo = random_direction(e, 0.05f);
        const Vec3 wi = i % 2 ? random_direction(e, 0.05f) : random_direction(e, -1);
        for (std::uint32_t which = 0; which < 2; ++which)
            jobs.push_back({.wo = wo, .wi = wi, .config = which, .seed = i});
    }
    const std::vector<ParamSet> both{a, b};
    RESTAGE_TRY(const auto answers, lab->run(both, jobs));
    std::vector<double> off;
    for (std::size_t i = 0; i < answers.size(); i += 2) {
        double worst = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const double x = answers[i].eval[c], y = answers[i + 1].eval[c];
            worst = std::max(worst, std::abs(x - y) / std::max({std::abs(x), std::abs(y), 1e-3}));
        }
        if (answers[i].pdf > 0 || worst > 0) off.push_back(worst);
    }
    if (off.empty()) return 0;
    std::sort(off.begin(), off.end());
    return s.table().stochastic ? off[off.size() / 2] : off.back();
}

// pbrt expresses some values differently (roughness as microfacet alpha, metals in one of two ways), so the BSDF
// must be equal where the values are not. Needs Restage's own importer and exporter.
Result<StepResult> through_pbrt(Subject& s, const scene::Scene& scene, std::size_t& otherwise) {
    RESTAGE_TRY(const std::filesystem::path bin, executable_dir());
    const auto plugins = bin.parent_path() / "lib/restage/plugins";
    Log silent([](LogLevel, std::string_view) {});
    plugin::Registry registry(silent, io::with_services());
    const plugin::SearchPath paths[] = {
        {s.folder, true}, {plugins / "importer-pbrt", true}, {plugins / "exporter-pbrt", true}};
    registry.scan(paths);
    if (!registry.find_importer("pbrt") || !registry.find_exporter("pbrt"))
        return StepResult::passed({}, "not through a pbrt file: its plugins are missing");
    const TemporaryFolder folder;
    const std::string file = (folder.path / "check.pbrt").string();
    if (const auto done = io::export_scene(scene, file, registry); !done)
        return fail("a scene with this material is not written as pbrt", done.error());
    const auto back = io::import_scene(file, registry, {.format = "pbrt"});
    if (!back) return fail("a pbrt file with this material is not read back", back.error());
    std::map<std::string, const scene::Material*> by_name;
    back->scene.materials.each([&](auto, const scene::Material& m) { by_name[m.name] = &m; });
    Engine e = s.random("params through pbrt");
    for (std::uint32_t i = 1; i <= scene.materials.size(); ++i) {
        const scene::Material& m = scene.materials[scene::Id<scene::Material>{i}];
        const auto found = by_name.find(m.name);
        if (found == by_name.end() || found->second->type != m.type)
            return StepResult::failed(fmt::format("a pbrt file returns {}\n  for {}",
                                                  found == by_name.end() ? "nothing" : found->second->type,
                                                  describe(m.params)));
        const ParamSet& other = found->second->params;
        if (same_values(s.table(), m.params, other)) continue;
        ++otherwise;
        RESTAGE_TRY(const double off, difference(s, m.params, other, e));
        if (!(off <= (s.table().stochastic ? 0.1 : 1e-2)))
            return StepResult::failed(
                fmt::format("a pbrt file returns a different material, whose f differs by {:.2g} %:\n  {}\n  for {}",
                            100 * off, describe(other), describe(m.params)));
    }
    return StepResult::passed({});
}

} // namespace

Result<StepResult> check_params(Subject& s) {
    if (s.table().params.size() == 0) return StepResult::skip("has no parameters");
    Engine e = s.random("params");
    std::vector<ParamSet> sets{{}};
    while (sets.size() < s.size(200, 50))
        sets.push_back(random_config(s.table(), e));
    const bool glsl = s.table().has_code();
    if (glsl) {
        RESTAGE_TRY(StepResult seen, through_glsl(s, sets));
        if (seen.verdict != Verdict::pass) return seen;
    }
    const scene::Scene scene = scene_of(s.table(), sets);
    RESTAGE_TRY(StepResult kept, through_project(s, scene));
    if (kept.verdict != Verdict::pass) return kept;
    std::size_t otherwise = 0;
    if (glsl) {
        RESTAGE_TRY(kept, through_pbrt(s, scene, otherwise));
        if (kept.verdict != Verdict::pass) return kept;
    }
    return StepResult::passed({{"parameters", double(s.table().params.size())},
                               {"sets", double(sets.size())},
                               {"expressed differently by pbrt", double(otherwise)}},
                              kept.text);
}

} // namespace restage::check

// SPDX-License-Identifier: Apache-2.0
#include "render/material_composer.hpp"

#include "render/glsl_values.hpp"
#include "render/texture_composer.hpp"

#include <fmt/format.h>
#include <string>
#include <utility>
#include <vector>

namespace restage::render {
namespace {

std::string default_value(const model::Param& p) {
    switch (p.type) {
        case model::ParamType::color:
            return spectrum(p, fmt::format("vec3({}, {}, {})", p.def[0], p.def[1], p.def[2]));
        case model::ParamType::number:
            return fmt::format("float({})", p.def[0]);
        case model::ParamType::boolean:
            return p.int_def != 0 ? "true" : "false";
        case model::ParamType::table:
            return "Table(uint64_t(0), 0u)";
        default:
            return fmt::format("{}", p.int_def);
    }
}

struct TexturedSlot {
    std::uint32_t word; // of the texture's id
    std::string id; // of the parameter
    bool color;
    const char* use; // TEXTURE_*
};

// Puts textures' values into the parameters. One call of texture_eval() for all slots: shader compilers inline it, with
// the code of every texture type of the scene, at each call.
std::string look_up(const std::vector<TexturedSlot>& slots) {
    if (slots.empty()) return "";
    std::string words, uses, taken;
    for (std::size_t k = 0; k < slots.size(); ++k) {
        const char* comma = k == 0 ? "" : ", ";
        words += fmt::format("{}{}u", comma, slots[k].word);
        uses += std::string(comma) + slots[k].use;
        taken += fmt::format("    if (w.at[at + {}] != 0u) m.{} = slot_value[{}]{};\n", slots[k].word, slots[k].id, k,
                             slots[k].color ? "" : ".x");
    }
    return fmt::format(R"(    const uint slot_word[{0}] = uint[{0}]({1}), slot_use[{0}] = uint[{0}]({2});
    Spectrum slot_value[{0}];
    for (uint i = 0u; i < {0}u; ++i) {{
        uint id = w.at[at + slot_word[i]];
        if (id != 0u) slot_value[i] = texture_eval(scene, id, where, slot_use[i]);
    }}
)",
                       slots.size(), words, uses) +
           taken;
}

gpu::ShaderSource compose(const MaterialType& type, const std::string& main_file, gpu::ShaderStage stage, bool stand_in,
                          ColorMode mode, std::span<const TextureType> textures = {}) {
    const model::Material& table = *type.plugin.table;
    const std::string prefix = table.prefix;
    std::string fields, fetch;
    std::uint32_t at = 0;
    std::vector<TexturedSlot> slots;
    bool colored = false, tables = false;
    for (std::uint32_t i = 0; i < table.params.size(); ++i) {
        const model::Param& line = table.params[i];
        const auto n = value_words(line);
        if (n == 0) continue;
        tables |= line.type == model::ParamType::table;
        fields += fmt::format("    {} {};\n", glsl_type(line), line.id);
        if (stand_in) {
            const bool color = line.type == model::ParamType::color && std::exchange(colored, true) == false;
            fetch += fmt::format("    m.{} = {};\n", line.id, color ? read_value(line, 0) : default_value(line));
            continue;
        }
        fetch += fmt::format("    m.{} = {};\n", line.id, read_value(line, at));
        if (line.texturable && type.is_textured(i)) { // otherwise omit texture code
            const bool color = line.type == model::ParamType::color;
            slots.push_back({.word = at + n,
                             .id = line.id,
                             .color = color,
                             .use = !color          ? "TEXTURE_DATA"
                                    : line.max <= 1 ? "TEXTURE_REFLECTANCE"
                                                    : "TEXTURE_UNBOUNDED"});
        }
        at += line_words(line);
    }
    fetch += look_up(slots);
    if (fields.empty()) fields = "    int unused;\n", fetch = "    m.unused = 0;\n";
    const char* rng = table.stochastic ? ", rng" : "";
    const bool site = table.site;

    gpu::ShaderSource source;
    source.name = stand_in ? "<stand-in>" : "<composed for " + type.type + ">";
    source.stage = stage;
    source.plugin_folders = {type.plugin.folder};
    if (type.plugin.source) source.texts = {type.plugin.source->glsl()};
    const std::string texture_code = compose_textures(textures, source);
    source.text = fmt::format(
        R"(#version 460
// revision {revision:016x} of the plugin's table and files: shaders made from this text are rebuilt when they change
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
{rt}#define RESTAGE_GLSL 1
{spectral}#include <restage/v1/bsdf.glsl>
#include <restage/v1/rng.glsl>
{table_api}{site_api}struct {p}_Params {{
{fields}}};
#include <plugin/{file}>
// Plugins' code stands before everything of the engine's, and cannot name it.
{textures}#include "lib/texture.glsl"
{tables}{material}Material material_fetch(SceneData scene, uint at, TextureAt where) {{
    UintArray w = UintArray(scene.params);
    {p}_Params m;
{before}{fetch}    {result}
}}
Spectrum material_eval(Material m, vec3 wo, vec3 wi, inout Rng rng) {{ return {p}_eval({m}, wo, wi{rng}); }}
float material_pdf(Material m, vec3 wo, vec3 wi, inout Rng rng) {{ return {p}_pdf({m}, wo, wi{rng}); }}
BsdfSample material_sample(Material m, vec3 wo, vec3 u, inout Rng rng) {{ return {p}_sample({m}, wo, u{rng}); }}
Spectrum material_albedo(Material m, vec3 wo) {{ return {p}_albedo({m}, wo); }}
#include "{main}"
)",
        fmt::arg("revision", type.plugin.revision()), fmt::arg("p", prefix), fmt::arg("fields", fields),
        fmt::arg("fetch", fetch), fmt::arg("table_api", tables ? "#include <restage/v1/table.glsl>\n" : ""),
        fmt::arg("site_api", site ? "#include <restage/v1/site.glsl>\n" : ""),
        fmt::arg("material", site ? fmt::format("#define MATERIAL_SITE 1\n"
                                                "struct Material {{ {}_Params params; Site site; }};\n",
                                                prefix)
                                  : fmt::format("#define Material {}_Params\n", prefix)),
        fmt::arg("result",
                 site ? "Material x;\n    x.params = m; // the caller fills in the site\n    return x;" : "return m;"),
        fmt::arg("m", site ? "m.params, m.site" : "m"),
        fmt::arg("spectral", mode == ColorMode::spectral ? "#define RESTAGE_SPECTRAL 1\n" : ""),
        fmt::arg("tables", tables ? "#include \"lib/table.glsl\"\n" : ""),
        fmt::arg("before", stand_in ? "    at -= 3u; // stand_in_color()\n" : ""), fmt::arg("rng", rng),
        fmt::arg("file", table.glsl_file), fmt::arg("main", main_file), fmt::arg("textures", texture_code),
        fmt::arg("rt", stage == gpu::ShaderStage::compute ? "" : "#extension GL_EXT_ray_tracing : require\n"));
    return source;
}

} // namespace

gpu::ShaderSource compose_material(const MaterialType& type, const std::string& main_file, gpu::ShaderStage stage,
                                   ColorMode color, std::span<const TextureType> textures) {
    return compose(type, main_file, stage, false, color, textures);
}
gpu::ShaderSource compose_stand_in(const MaterialType& type, const std::string& main_file, gpu::ShaderStage stage,
                                   ColorMode color) {
    return compose(type, main_file, stage, true, color);
}

void set_color_mode(ColorMode mode, gpu::ShaderSource& source) {
    static constexpr std::string_view before = "#include \"lib/extensions.glsl\"\n";
    const std::size_t at = source.text.find(before); // every file of shaders/ has it
    if (mode == ColorMode::spectral && at != std::string::npos) source.text.insert(at, "#define RESTAGE_SPECTRAL 1\n");
}

plugin::Registry::Judge material_judge(std::filesystem::path shader_dir) {
    auto compiler = std::make_shared<const gpu::ShaderCompiler>(
        gpu::ShaderCompilerOptions{.include_dirs = {std::move(shader_dir)}, .cache_dir = {}});
    return [compiler](const plugin::MaterialEntry& entry) -> Result<> {
        const CrashNote note(entry.blame);
        MaterialType type;
        type.type = entry.table->type;
        type.plugin = {entry.table, entry.plugin->folder, entry.source};
        type.textured.assign(entry.table->params.size(), true);
        if (type.mix() || type.null_surface()) return {};
        RESTAGE_CHECK(compiler->compile(compose_material(type, "wave_shade.glsl", gpu::ShaderStage::compute)));
        return {};
    };
}

bool evaluates_textures(const SceneFeatures& f, const MaterialType& type) {
    return type.bump || !type.textured.empty() || f.emission_textures || f.light_alpha;
}

std::vector<gpu::SpecConstant> spec_constants(const SceneFeatures& f, bool guides, Strategy strategy,
                                              const MaterialType* type) {
    const bool bump = type && type->bump;
    const bool textures = type && (bump || !type->textured.empty());
    const bool tangents = type && (bump || type->plugin.table->tangent);
    return {{0, f.environment},
            {1, textures},
            {2, bump},
            {3, f.lens},
            {4, f.media},
            {5, guides},
            {6, std::uint32_t(strategy)},
            {7, tangents},
            {8, f.filter_table},
            {10, f.borders},
            {11, f.emission_textures},
            {12, f.light_alpha},
            {13, f.glow},
            {14, f.camera},
            {15, f.quadrics},
            {16, f.lights},
            {17, f.light_roots},
            {18, f.curves || (type && type->curves)},
            {19, f.caustics},
            {20, f.guiding},
            {21, f.catchers}};
}

} // namespace restage::render

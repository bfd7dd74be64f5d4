// SPDX-License-Identifier: Apache-2.0
#include "render/texture_composer.hpp"

#include "render/glsl_values.hpp"
#include "render/material_types.hpp"
#include "shared/scene_data.h"

#include <fmt/format.h>
#include <algorithm>
#include <vector>

namespace restage::render {
namespace {

bool is_value(const model::Param& line) { return value_words(line) > 0; }

// struct p_Params, and the plugin's code.
std::string declare(const TextureType& type, gpu::ShaderSource& source) {
    const model::Texture& table = *type.plugin.table;
    const std::size_t folder = source.plugin_folders.size();
    source.plugin_folders.push_back(type.plugin.folder);
    if (type.plugin.source) source.texts.push_back(type.plugin.source->glsl());
    std::string fields;
    if (table.image) fields += "    TextureImage image;\n";
    for (const model::Param& line : table.params)
        if (is_value(line)) fields += fmt::format("    {} {};\n", glsl_type(line), line.id);
    if (fields.empty()) fields = "    int unused;\n";
    return fmt::format("// revision {:016x}\nstruct {}_Params {{\n{}}};\n#include <plugin:{}/{}>\n",
                       type.plugin.revision(), table.prefix, fields, folder, table.glsl_file);
}

// One case: pops the operands off the stack, the last one first, and calls the plugin.
std::string operation(const TextureType& type, std::size_t kind) {
    const model::Texture& table = *type.plugin.table;
    std::uint32_t at = 2, bit = TEXTURE_OP_FIRST_OPERAND;
    std::string before, operands, fetch;
    if (table.mapped) {
        before += fmt::format("        texture_map(w, at + {}u, site);\n", at);
        at += map_words;
    }
    if (table.image) before += fmt::format("        m.image = texture_image_of(scene, w.at[at + {}u]);\n", at++);
    for (const model::Param& line : table.params) {
        if (!is_value(line)) continue;
        std::string value = read_value(line, at);
        if (line.type == model::ParamType::color)
            value = fmt::format("texture_color(site, texture_words3(w, at + {}u))", at);
        at += value_words(line);
        if (line.texturable) {
            operands =
                fmt::format("        m.{} = texture_operand(head, {}u, {}, s);\n", line.id, bit, value) + operands;
            bit <<= 1;
        } else {
            fetch += fmt::format("        m.{} = {};\n", line.id, value);
        }
    }
    return fmt::format(
        "    if (kind == {}u) {{\n        {}_Params m;\n{}{}{}        at += {}u;\n        return "
        "{}_texture(m, site);\n    }}\n",
        kind, table.prefix, before, fetch, operands, at, table.prefix);
}

} // namespace

std::string compose_textures(std::span<const TextureType> types, gpu::ShaderSource& source) {
    const auto composed = [](const TextureType& t) { return t.composed(); };
    if (std::ranges::none_of(types, composed)) return "";
    const bool sites =
        std::ranges::any_of(types, [](const TextureType& t) { return t.composed() && t.plugin.table->site; });
    std::string code = sites ? "#define RESTAGE_TEXTURE_SITES 1\n" : "";
    code += "#include <restage/v1/texture.glsl>\n";
    for (const TextureType& type : types)
        if (type.composed()) code += declare(type, source);
    code += R"(#define TEXTURE_TYPES 1
#include "lib/texture.glsl"
Spectrum texture_operation(SceneData scene, UintArray w, uint head, inout uint at, TextureAt where, uint use_, inout TextureStack s) {
    uint kind = head & TEXTURE_KIND;
    TextureSite site = texture_site(head, where, use_);
)";
    for (std::size_t i = 0; i < types.size(); ++i)
        if (types[i].composed()) code += operation(types[i], i + 1);
    return code + "    return texture_other(w, head, at, site, s);\n}\n";
}

void insert_textures(std::span<const TextureType> types, gpu::ShaderSource& source) {
    const std::string code = compose_textures(types, source);
    if (code.empty()) return;
    static constexpr std::string_view after = "#include \"lib/extensions.glsl\"\n";
    const std::size_t at = source.text.find(after);
    if (at == std::string::npos) return; // every file of shaders/ has it
    source.text.insert(at + after.size(), "#define RESTAGE_GLSL 1\n" + code);
}

plugin::Registry::TextureJudge texture_judge(std::filesystem::path shader_dir) {
    auto compiler = std::make_shared<const gpu::ShaderCompiler>(
        gpu::ShaderCompilerOptions{.include_dirs = {std::move(shader_dir)}, .cache_dir = {}});
    return [compiler](const plugin::TextureEntry& entry) -> Result<> {
        const CrashNote note(entry.blame);
        const TextureType type{entry.table->type, {entry.table, entry.plugin->folder, entry.source, entry.blame}};
        gpu::ShaderSource source{.name = "<composed for " + type.type + ">", .text = R"(#version 460
#extension GL_GOOGLE_include_directive : require
#include "lib/extensions.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { uint64_t scene; uint texture_id; };
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Out { vec4 value; };
void main() {
    SceneData data = SceneRef(scene).scene;
    Out(scene).value.xyz = texture_data(data, texture_id, texture_at_uv(vec4(0)));
}
)"};
        insert_textures({&type, 1}, source);
        RESTAGE_CHECK(compiler->compile(source));
        return {};
    };
}

} // namespace restage::render

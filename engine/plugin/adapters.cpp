// SPDX-License-Identifier: Apache-2.0
#include "plugin/adapters.hpp"

#include "plugin/abi.hpp"

#include <algorithm>

namespace restage::plugin {

namespace {

std::string text(const char* c) { return c ? c : ""; }

} // namespace

// Both enumerations have the same order.
static_assert(static_cast<int>(model::ParamType::number) == 0 && RESTAGE_FLOAT == 1 &&
              static_cast<int>(model::ParamType::table) == RESTAGE_TABLE - RESTAGE_FLOAT);

std::uint32_t abi_type(model::ParamType type) { return static_cast<std::uint32_t>(type) + RESTAGE_FLOAT; }

std::optional<model::ParamType> model_type(std::uint32_t type) {
    if (type < RESTAGE_FLOAT || type > RESTAGE_TABLE) return std::nullopt;
    return static_cast<model::ParamType>(type - RESTAGE_FLOAT);
}

std::vector<std::string> split_words(std::string_view text) {
    std::vector<std::string> parts;
    for (;;) {
        const std::size_t bar = text.find('|');
        parts.emplace_back(text.substr(0, bar));
        if (bar == std::string_view::npos) return parts;
        text.remove_prefix(bar + 1);
    }
}

Result<std::vector<model::Param>> read_params(const RestageParam* params, std::uint32_t count) {
    if (count > 0 && !params) return fail("its parameter table is missing");
    if (count > 4096) return fail(std::to_string(count) + " parameters are implausible");
    std::vector<model::Param> out;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (const auto problem = too_short(params->size, RESTAGE_SIZE_UP_TO(RestageParam, label), "of parameters");
            !problem.empty())
            return fail("parameter " + std::to_string(i) + ": " + problem);
        const RestageParam in = element(params, i);
        const std::string who = "parameter " + (in.id ? "\"" + std::string(in.id) + "\"" : std::to_string(i));
        if (!in.id) return fail(who + ": its id is NULL");
        if (!in.label) return fail(who + " has no label");
        const auto type = model_type(in.type);
        if (!type) return fail(who + ": its type " + std::to_string(in.type) + " is unknown");
        model::Param p{.id = in.id,
                       .label = in.label,
                       .type = *type,
                       .texturable = (in.flags & RESTAGE_PARAM_TEXTURABLE) != 0,
                       .advanced = (in.flags & RESTAGE_PARAM_ADVANCED) != 0,
                       .min = in.min,
                       .max = in.max,
                       .int_min = in.int_min,
                       .int_max = in.int_max,
                       .int_def = in.int_def,
                       .unit = text(in.unit),
                       .tooltip = text(in.tooltip)};
        std::copy_n(in.def, 4, p.def.begin());
        if (p.type == model::ParamType::choice && in.choices && *in.choices) p.choices = split_words(in.choices);
        if (p.type == model::ParamType::table) p.file = text(in.choices);
        out.push_back(std::move(p));
    }
    return out;
}

GivenTable::GivenTable(model::ParamTable table) : params_(table.begin(), table.end()) {
    choices_.reserve(params_.size());
    for (const model::Param& p : params_) {
        choices_.push_back(p.type == model::ParamType::table ? p.file : choices_text(p));
        RestageParam out{};
        out.type = abi_type(p.type);
        if (p.texturable) out.flags |= RESTAGE_PARAM_TEXTURABLE;
        if (p.advanced) out.flags |= RESTAGE_PARAM_ADVANCED;
        out.int_min = p.int_min, out.int_max = p.int_max, out.int_def = p.int_def;
        out.min = p.min, out.max = p.max;
        std::copy(p.def.begin(), p.def.end(), out.def);
        out.id = p.id.c_str(), out.label = p.label.c_str(), out.unit = p.unit.c_str();
        out.choices = choices_.back().empty() ? nullptr : choices_.back().c_str();
        out.tooltip = p.tooltip.c_str();
        lines_.push_back(out);
    }
    lines_.emplace_back();
}

Result<model::Material> read_material1(const void* table) {
    const auto& given = *static_cast<const RestageMaterial1*>(table);
    if (const auto problem =
            too_short(given.size, RESTAGE_SIZE_UP_TO(RestageMaterial1, param_count), RESTAGE_MATERIAL1);
        !problem.empty())
        return fail(problem);
    const RestageMaterial1 in = sized(given);
    const auto has = [&](std::uint32_t flag) { return (in.flags & flag) != 0; };
    model::Material out{.type = text(in.type),
                        .label = text(in.label),
                        .prefix = text(in.prefix),
                        .glsl_file = text(in.glsl_file),
                        .tooltip = text(in.tooltip),
                        .params = {},
                        .emission = {},
                        .stochastic = has(RESTAGE_MATERIAL_STOCHASTIC),
                        .lossless = has(RESTAGE_MATERIAL_LOSSLESS),
                        .transmissive = has(RESTAGE_MATERIAL_TRANSMISSIVE),
                        .nonreciprocal = has(RESTAGE_MATERIAL_NONRECIPROCAL),
                        .null_surface = has(RESTAGE_MATERIAL_NULL),
                        .mix = has(RESTAGE_MATERIAL_MIX),
                        .tangent = has(RESTAGE_MATERIAL_TANGENT),
                        .site = has(RESTAGE_MATERIAL_SITE),
                        .additive = has(RESTAGE_MATERIAL_ADDITIVE)};
    auto params = read_params(in.params, in.param_count);
    if (!params) return fail("material \"" + out.type + "\": " + params.error().message);
    out.params = std::move(*params);
    return out;
}

std::span<const MaterialAdapter> material_adapters() {
    static constexpr MaterialAdapter all[] = {{RESTAGE_MATERIAL1, read_material1}};
    return all;
}

Result<DeclaredTexture> read_texture1(const RestageTexture1& given) {
    if (const auto problem = too_short(given.size, RESTAGE_SIZE_UP_TO(RestageTexture1, param_count), RESTAGE_TEXTURE1);
        !problem.empty())
        return fail(problem);
    const RestageTexture1 in = sized(given);
    const auto has = [&](std::uint32_t flag) { return (in.flags & flag) != 0; };
    DeclaredTexture out{.texture = {.type = text(in.type),
                                    .label = text(in.label),
                                    .prefix = text(in.prefix),
                                    .glsl_file = text(in.glsl_file),
                                    .tooltip = text(in.tooltip),
                                    .params = {},
                                    .image = has(RESTAGE_TEXTURE_IMAGE),
                                    .mapped = has(RESTAGE_TEXTURE_MAPPED),
                                    .site = has(RESTAGE_TEXTURE_SITE)},
                        .eval = in.eval};
    const std::string who = "texture \"" + out.texture.type + "\": ";
    if (out.eval && out.texture.site) return fail(who + "with SITE it can have no native evaluation");
    auto params = read_params(in.params, in.param_count);
    if (!params) return fail(who + params.error().message);
    out.texture.params = std::move(*params);
    return out;
}

Result<DeclaredEmission> read_emission1(const RestageEmission1& given) {
    if (const auto problem = too_short(given.size, RESTAGE_SIZE_UP_TO(RestageEmission1, radiance), RESTAGE_EMISSION1);
        !problem.empty())
        return fail(problem);
    const RestageEmission1 in = sized(given);
    return DeclaredEmission{text(in.type), {text(in.radiance), text(in.scale), text(in.two_sided)}};
}

Result<model::Importer> read_importer1(const RestageImporter1& given) {
    if (const auto problem = too_short(given.size, RESTAGE_SIZE_UP_TO(RestageImporter1, load), RESTAGE_IMPORTER1);
        !problem.empty())
        return fail(problem);
    const RestageImporter1 in = sized(given);
    if (!in.probe || !in.load) return fail("importer \"" + text(in.format) + "\" lacks probe or load");
    auto options = read_params(in.options, in.option_count);
    if (!options) return fail("importer \"" + text(in.format) + "\": option table: " + options.error().message);
    return model::Importer{text(in.format), text(in.label), split_words(text(in.extensions)), std::move(*options)};
}

Result<model::Exporter> read_exporter1(const RestageExporter1& given) {
    if (const auto problem = too_short(given.size, RESTAGE_SIZE_UP_TO(RestageExporter1, save), RESTAGE_EXPORTER1);
        !problem.empty())
        return fail(problem);
    const RestageExporter1 in = sized(given);
    if (!in.save) return fail("exporter \"" + text(in.format) + "\" lacks save");
    auto options = read_params(in.options, in.option_count);
    if (!options) return fail("exporter \"" + text(in.format) + "\": option table: " + options.error().message);
    return model::Exporter{text(in.format), text(in.label), split_words(text(in.extensions)), std::move(*options)};
}

Result<model::Action> read_action1(const RestageAction1& given) {
    if (const auto problem = too_short(given.size, RESTAGE_SIZE_UP_TO(RestageAction1, run), RESTAGE_ACTION1);
        !problem.empty())
        return fail(problem);
    const RestageAction1 in = sized(given);
    if (!in.run) return fail("action \"" + text(in.id) + "\" lacks run");
    auto params = read_params(in.params, in.param_count);
    if (!params) return fail("action \"" + text(in.id) + "\": " + params.error().message);
    return model::Action{text(in.id), text(in.label), text(in.tooltip), std::move(*params),
                         (in.flags & RESTAGE_ACTION_NEEDS_SELECTION) != 0};
}

Result<model::Panel> read_panel1(const RestagePanel1& given) {
    if (const auto problem = too_short(given.size, RESTAGE_SIZE_UP_TO(RestagePanel1, draw), RESTAGE_PANEL1);
        !problem.empty())
        return fail(problem);
    const RestagePanel1 in = sized(given);
    if (!in.draw) return fail("panel \"" + text(in.id) + "\" lacks draw");
    auto params = read_params(in.params, in.param_count);
    if (!params) return fail("panel \"" + text(in.id) + "\": " + params.error().message);
    return model::Panel{text(in.id), text(in.label), std::move(*params)};
}

Result<model::Sky> read_sky1(const RestageSky1& given) {
    if (const auto problem = too_short(given.size, RESTAGE_SIZE_UP_TO(RestageSky1, make), RESTAGE_SKY1);
        !problem.empty())
        return fail(problem);
    const RestageSky1 in = sized(given);
    const std::string who = "sky \"" + text(in.type) + "\"";
    if (!in.make) return fail(who + " lacks make");
    auto params = read_params(in.params, in.param_count);
    if (!params) return fail(who + ": " + params.error().message);
    return model::Sky{text(in.type), text(in.label), text(in.tooltip), std::move(*params)};
}

} // namespace restage::plugin

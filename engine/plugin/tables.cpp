// SPDX-License-Identifier: Apache-2.0
#include "plugin/tables.hpp"

#include "plugin/glsl_words.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

namespace restage::plugin {

namespace fs = std::filesystem;

namespace {

std::string quoted(const char* text) { return std::string("\"") + text + "\""; }

std::vector<std::string_view> split(std::string_view text) { // at '|'
    std::vector<std::string_view> parts;
    for (;;) {
        const std::size_t bar = text.find('|');
        parts.push_back(text.substr(0, bar));
        if (bar == std::string_view::npos) return parts;
        text.remove_prefix(bar + 1);
    }
}

std::string check_range(const RestageParam& p, int components) {
    if (!std::isfinite(p.min) || !std::isfinite(p.max) || !(p.min <= p.max)) return "its range is not a range";
    for (int i = 0; i < components; ++i)
        if (!(p.def[i] >= p.min && p.def[i] <= p.max)) return "its default is out of its range";
    return "";
}

std::string check_param(const RestageParam& p) {
    const bool texturable = p.flags & RESTAGE_PARAM_TEXTURABLE;
    if (texturable && p.type != RESTAGE_FLOAT && p.type != RESTAGE_COLOR)
        return "only FLOAT and COLOR can be texturable";
    switch (p.type) {
        case RESTAGE_FLOAT:
            return check_range(p, 1);
        case RESTAGE_COLOR:
            return check_range(p, 3);
        case RESTAGE_INT:
            return p.def[0] == std::floor(p.def[0]) ? check_range(p, 1) : "its default is not a whole number";
        case RESTAGE_BOOL:
            return p.def[0] == 0 || p.def[0] == 1 ? "" : "its default is neither 0 nor 1";
        case RESTAGE_ENUM: {
            if (!p.choices || !*p.choices) return "it has no choices";
            const auto choices = split(p.choices);
            if (std::set(choices.begin(), choices.end()).size() != choices.size() ||
                std::count(choices.begin(), choices.end(), ""))
                return "a choice is empty or there twice";
            return p.def[0] >= 0 && p.def[0] < static_cast<float>(choices.size()) && p.def[0] == std::floor(p.def[0])
                       ? ""
                       : "its default is not the index of a choice";
        }
        case RESTAGE_TEXT:
        case RESTAGE_MATERIAL:
        case RESTAGE_TEXTURE:
        case RESTAGE_TABLE:
            return "";
        default:
            return "its type " + std::to_string(p.type) + " is unknown";
    }
}

bool is_type_name(std::string_view name) { // lower_snake, as scene files write it
    return !name.empty() && name[0] >= 'a' && name[0] <= 'z' && std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
}

template <class T>
std::string check_size(const T& table, const char* interface_id) {
    if (table.size >= sizeof(T)) return "";
    return std::string("its table ") + interface_id + " has " + std::to_string(table.size) + " bytes, " +
           std::to_string(sizeof(T)) + " are needed: rebuild it with this SDK";
}

bool has_param(const RestageMaterial1& m, std::string_view id, std::uint32_t type) {
    return std::any_of(m.params, m.params + m.param_count,
                       [&](const RestageParam& p) { return p.id == id && p.type == type; });
}

std::string check_default_table(const RestageParam& p, const fs::path& folder) {
    if (p.type != RESTAGE_TABLE || !p.choices || !*p.choices) return "";
    const fs::path file = fs::path(p.choices).lexically_normal();
    const std::string who = "parameter " + quoted(p.id) + ": its default, ";
    if (file.is_absolute() || file.has_root_name() || *file.begin() == "..")
        return who + quoted(p.choices) + ", is outside of the plugin's folder";
    std::error_code code;
    return fs::is_regular_file(folder / file, code) ? "" : who + (folder / file).string() + ", is missing";
}

std::string check_format(const char* what, const char* format, const char* label, const char* extensions) {
    if (!format || !is_type_name(format)) return std::string("an ") + what + " without a proper format name";
    if (!label || !*label || !extensions || !*extensions)
        return std::string(what) + " " + quoted(format) + " has no label or no extensions";
    return "";
}

} // namespace

bool is_glsl_identifier(std::string_view name) {
    if (name.empty() || name.size() > 64 || (name[0] >= '0' && name[0] <= '9') || name.starts_with("gl_") ||
        name.find("__") != std::string_view::npos)
        return false;
    const bool letters = std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    });
    return letters && !is_glsl_word(name);
}

bool is_taken_prefix(std::string_view prefix) { return prefix == "material"; }

std::string check_params(const RestageParam* params, std::uint32_t count) {
    if (count > 0 && !params) return "its parameter table is missing";
    if (count > 4096) return std::to_string(count) + " parameters are not believable";
    std::set<std::string_view> ids;
    for (std::uint32_t i = 0; i < count; ++i) {
        const RestageParam& p = params[i];
        if (p.id && is_glsl_word(p.id))
            return "parameter " + std::to_string(i) + ": " + quoted(p.id) +
                   " is a word of GLSL (a keyword, a type, or taken by the shaders around it): call it otherwise";
        if (!p.id || !is_glsl_identifier(p.id))
            return "parameter " + std::to_string(i) + ": " + (p.id ? quoted(p.id) : "an id that is NULL") +
                   " is no GLSL identifier: letters, digits and single underscores, no digit first, not gl_...";
        if (!ids.insert(p.id).second) return "parameter " + quoted(p.id) + " is there twice";
        if (!p.label) return "parameter " + quoted(p.id) + " has no label";
        if (const std::string problem = check_param(p); !problem.empty())
            return "parameter " + quoted(p.id) + ": " + problem;
    }
    return "";
}

std::string check_table(const RestageMaterial1& m, const fs::path& folder) {
    if (const std::string problem = check_size(m, RESTAGE_MATERIAL1); !problem.empty()) return problem;
    if (!m.type || !is_type_name(m.type)) return "a material without a proper type name (lower case, digits, _)";
    const std::string who = "material " + quoted(m.type);
    if (!m.label || !*m.label) return who + " has no label";
    const bool has_code = !(m.flags & (RESTAGE_MATERIAL_MIX | RESTAGE_MATERIAL_NULL));
    if (m.prefix ? !is_glsl_identifier(m.prefix) || std::string_view(m.prefix).back() == '_' : has_code)
        return who + ": its prefix " + (m.prefix ? quoted(m.prefix) : "NULL") +
               " is no GLSL identifier, or ends with an underscore";
    if (m.prefix && is_taken_prefix(m.prefix))
        return who + ": its prefix " + quoted(m.prefix) + " is taken: the functions around a material begin with it";
    if (const std::string problem = check_params(m.params, m.param_count); !problem.empty())
        return who + ": " + problem;
    for (std::uint32_t i = 0; i < m.param_count; ++i)
        for (const std::string_view taken : {"bump", "normalmap"})
            if (taken == m.params[i].id)
                return who + ": parameter \"" + std::string(taken) + "\" belongs to the host: every material has it";
    for (std::uint32_t i = 0; i < m.param_count; ++i)
        if (const std::string problem = check_default_table(m.params[i], folder); !problem.empty())
            return who + ": " + problem;
    if (m.flags & RESTAGE_MATERIAL_MIX)
        return has_param(m, "first", RESTAGE_MATERIAL) && has_param(m, "second", RESTAGE_MATERIAL) &&
                       has_param(m, "amount", RESTAGE_FLOAT)
                   ? ""
                   : who + ": a mix needs the parameters first, second (MATERIAL) and amount (FLOAT)";
    if (!has_code) return "";
    if (!m.glsl_file || !*m.glsl_file) return who + " names no GLSL file";
    const fs::path glsl = fs::path(m.glsl_file).lexically_normal();
    if (glsl.is_absolute() || glsl.has_root_name() || *glsl.begin() == "..")
        return who + ": the GLSL file " + quoted(m.glsl_file) + " is outside of the plugin's folder";
    std::error_code code;
    if (!fs::is_regular_file(folder / glsl, code)) return who + ": " + (folder / glsl).string() + " is missing";
    return "";
}

std::string check_table(const RestageImporter1& t) {
    if (const std::string problem = check_size(t, RESTAGE_IMPORTER1); !problem.empty()) return problem;
    if (const std::string problem = check_format("importer", t.format, t.label, t.extensions); !problem.empty())
        return problem;
    return t.probe && t.load ? "" : "importer " + quoted(t.format) + " lacks probe or load";
}

std::string check_table(const RestageExporter1& t) {
    if (const std::string problem = check_size(t, RESTAGE_EXPORTER1); !problem.empty()) return problem;
    if (const std::string problem = check_format("exporter", t.format, t.label, t.extensions); !problem.empty())
        return problem;
    if (const std::string problem = check_params(t.options, t.option_count); !problem.empty())
        return "exporter " + quoted(t.format) + ": option table: " + problem;
    return t.save ? "" : "exporter " + quoted(t.format) + " lacks save";
}

std::string check_table(const RestageDenoiser1& t) {
    if (const std::string problem = check_size(t, RESTAGE_DENOISER1); !problem.empty()) return problem;
    if (!t.type || !is_type_name(t.type) || !t.label || !*t.label)
        return "a denoiser without a proper type name or label";
    return t.available && t.run ? "" : "denoiser " + quoted(t.type) + " lacks available or run";
}

std::string check_table(const RestageInspector1& t) {
    if (const std::string problem = check_size(t, RESTAGE_INSPECTOR1); !problem.empty()) return problem;
    if (!t.type || !is_type_name(t.type)) return "an inspector that does not say for which material it is";
    return t.draw ? "" : "the inspector of " + quoted(t.type) + " lacks draw";
}

std::string check_table(const RestageTable1& t) {
    if (const std::string problem = check_size(t, RESTAGE_TABLE1); !problem.empty()) return problem;
    if (!t.type || !is_type_name(t.type)) return "a reader of tables that does not say for which material it is";
    if (!t.extensions || !*t.extensions) return "the reader of tables of " + quoted(t.type) + " names no extensions";
    return t.read ? "" : "the reader of tables of " + quoted(t.type) + " lacks read";
}

std::string check_table(const RestageEmission1& t) {
    if (const std::string problem = check_size(t, RESTAGE_EMISSION1); !problem.empty()) return problem;
    if (!t.type || !is_type_name(t.type)) return "an emission that does not say of which material it is";
    return t.radiance ? "" : "the emission of " + quoted(t.type) + " names no parameter as its radiance";
}

std::string check_emission(const RestageEmission1& e, const RestageMaterial1& m) {
    const std::string who = "the emission of " + quoted(e.type) + ": ";
    if (m.flags & (RESTAGE_MATERIAL_MIX | RESTAGE_MATERIAL_NULL))
        return who + "a mix, or what is no surface, cannot shine";
    const auto lacks = [&](const char* role, const char* id, RestageType type, const char* kind) {
        return id && !has_param(m, id, type)
                   ? who + "its " + role + " " + quoted(id) + " is no parameter of type " + kind + " of that material"
                   : std::string();
    };
    std::string problem = lacks("radiance", e.radiance, RESTAGE_COLOR, "COLOR");
    if (problem.empty()) problem = lacks("scale", e.scale, RESTAGE_FLOAT, "FLOAT");
    if (problem.empty()) problem = lacks("two_sided", e.two_sided, RESTAGE_BOOL, "BOOL");
    for (std::uint32_t i = 0; problem.empty() && e.scale && i < m.param_count; ++i)
        if (std::string_view(m.params[i].id) == e.scale && (m.params[i].flags & RESTAGE_PARAM_TEXTURABLE))
            problem = who + "its scale " + quoted(e.scale) + " may be a texture; only the radiance may";
    return problem;
}

bool has_table(const RestageMaterial1& m) {
    return std::any_of(m.params, m.params + m.param_count,
                       [](const RestageParam& p) { return p.type == RESTAGE_TABLE; });
}

} // namespace restage::plugin

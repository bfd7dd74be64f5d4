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

using model::ParamType;

std::string quote(std::string_view text) { return "\"" + std::string(text) + "\""; }

std::string check_range(const model::Param& p) {
    if (!std::isfinite(p.min) || !std::isfinite(p.max) || !(p.min <= p.max)) return "its range is invalid";
    for (std::size_t i = 0; i < std::size_t(p.components()); ++i)
        if (!(p.def[i] >= p.min && p.def[i] <= p.max)) return "its default is out of its range";
    return "";
}

std::string check_param(const model::Param& p) {
    if (p.texturable && p.type != ParamType::number && p.type != ParamType::color)
        return "only FLOAT and COLOR can be texturable";
    switch (p.type) {
        case ParamType::number:
        case ParamType::color:
            return check_range(p);
        case ParamType::integer:
            if (p.int_min > p.int_max) return "its range is invalid";
            return p.int_def >= p.int_min && p.int_def <= p.int_max ? "" : "its default is out of its range";
        case ParamType::boolean:
            return p.int_def == 0 || p.int_def == 1 ? "" : "its default is neither 0 nor 1";
        case ParamType::choice:
            if (p.choices.empty()) return "it has no choices";
            if (std::set(p.choices.begin(), p.choices.end()).size() != p.choices.size() ||
                std::count(p.choices.begin(), p.choices.end(), ""))
                return "a choice is empty or duplicate";
            return p.int_def >= 0 && std::size_t(p.int_def) < p.choices.size()
                       ? ""
                       : "its default is not the index of a choice";
        case ParamType::text:
        case ParamType::material:
        case ParamType::texture:
        case ParamType::table:
            return "";
    }
    return "";
}

std::string check_glsl(const std::string& file, const fs::path& folder, const std::string& who) {
    if (file.empty()) return who + " names no GLSL file";
    const fs::path glsl = fs::path(file).lexically_normal();
    if (glsl.is_absolute() || glsl.has_root_name() || *glsl.begin() == "..")
        return who + ": the GLSL file " + quote(file) + " is outside of the plugin's folder";
    std::error_code code;
    return fs::is_regular_file(folder / glsl, code) ? "" : who + ": " + (folder / glsl).string() + " is missing";
}

bool has_param(const model::Material& m, std::string_view id, ParamType type) {
    const model::Param* p = m.find(id);
    return p && p->type == type;
}

std::string check_default_table(const model::Param& p, const fs::path& folder) {
    if (p.type != ParamType::table || p.file.empty()) return "";
    const fs::path file = fs::path(p.file).lexically_normal();
    const std::string who = "parameter " + quote(p.id) + ": its default, ";
    if (file.is_absolute() || file.has_root_name() || *file.begin() == "..")
        return who + quote(p.file) + ", is outside of the plugin's folder";
    std::error_code code;
    return fs::is_regular_file(folder / file, code) ? "" : who + (folder / file).string() + ", is missing";
}

std::string check_format(const char* what, const std::string& format, const std::string& label,
                         const std::vector<std::string>& extensions) {
    if (!is_type_name(format)) return std::string("an ") + what + " without a proper format name";
    if (label.empty() || extensions.empty() || extensions[0].empty())
        return std::string(what) + " " + quote(format) + " has no label or no extensions";
    return "";
}

std::string check_emission(const model::Emission& e, const model::Material& m) {
    const std::string who = "the emission of " + quote(m.type) + ": ";
    if (!m.has_code()) return who + "a mix or a null surface cannot emit";
    if (e.radiance.empty()) return who + "it names no parameter as its radiance";
    const auto lacks = [&](const char* role, const std::string& id, ParamType type, const char* kind) {
        return !id.empty() && !has_param(m, id, type)
                   ? who + "its " + role + " " + quote(id) + " is not a parameter of type " + kind + " of that material"
                   : std::string();
    };
    std::string problem = lacks("radiance", e.radiance, ParamType::color, "COLOR");
    if (problem.empty()) problem = lacks("scale", e.scale, ParamType::number, "FLOAT");
    if (problem.empty()) problem = lacks("two_sided", e.two_sided, ParamType::boolean, "BOOL");
    if (problem.empty() && !e.scale.empty() && m.find(e.scale)->texturable)
        problem = who + "its scale " + quote(e.scale) + " may be a texture; only the radiance may";
    return problem;
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

bool is_taken_prefix(std::string_view prefix) { return prefix == "material" || prefix == "texture"; }

bool is_type_name(std::string_view name) {
    return !name.empty() && name[0] >= 'a' && name[0] <= 'z' && std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
}

std::string check_params(model::ParamTable params) {
    std::set<std::string_view> ids;
    for (std::size_t i = 0; i < params.size(); ++i) {
        const model::Param& p = params[i];
        if (is_glsl_word(p.id))
            return "parameter " + std::to_string(i) + ": " + quote(p.id) +
                   " is a reserved word of GLSL (a keyword, a type, or used by the surrounding shaders): rename it";
        if (!is_glsl_identifier(p.id))
            return "parameter " + std::to_string(i) + ": " + quote(p.id) +
                   " is not a GLSL identifier: letters, digits and single underscores, no digit first, not gl_...";
        if (!ids.insert(p.id).second) return "parameter " + quote(p.id) + " is a duplicate";
        if (const std::string problem = check_param(p); !problem.empty())
            return "parameter " + quote(p.id) + ": " + problem;
    }
    return "";
}

std::string check_material(const model::Material& m, const fs::path& folder) {
    if (!is_type_name(m.type)) return "a material without a proper type name (lower case, digits, _)";
    const std::string who = "material " + quote(m.type);
    if (m.label.empty()) return who + " has no label";
    if (m.prefix.empty() ? m.has_code() : !is_glsl_identifier(m.prefix) || m.prefix.back() == '_')
        return who + ": its prefix " + (m.prefix.empty() ? "NULL" : quote(m.prefix)) +
               " is not a GLSL identifier, or ends with an underscore";
    if (is_taken_prefix(m.prefix))
        return who + ": its prefix " + quote(m.prefix) + " is reserved: the functions around a material begin with it";
    if (const std::string problem = check_params(m.params); !problem.empty()) return who + ": " + problem;
    for (const std::string_view taken : {"bump", "normalmap"})
        if (m.find(taken)) return who + ": parameter " + quote(taken) + " is reserved: every material has it";
    for (const model::Param& p : m.params)
        if (const std::string problem = check_default_table(p, folder); !problem.empty()) return who + ": " + problem;
    if (m.emission)
        if (const std::string problem = check_emission(*m.emission, m); !problem.empty()) return problem;
    if (m.mix)
        return has_param(m, "first", ParamType::material) && has_param(m, "second", ParamType::material) &&
                       has_param(m, "amount", ParamType::number)
                   ? ""
                   : who + ": a mix needs the parameters first, second (MATERIAL) and amount (FLOAT)";
    return m.has_code() ? check_glsl(m.glsl_file, folder, who) : "";
}

std::string check_texture(const model::Texture& t, const fs::path& folder) {
    if (!is_type_name(t.type)) return "a texture without a proper type name (lower case, digits, _)";
    const std::string who = "texture " + quote(t.type);
    if (t.label.empty()) return who + " has no label";
    if (!is_glsl_identifier(t.prefix) || t.prefix.back() == '_')
        return who + ": its prefix " + quote(t.prefix) + " is not a GLSL identifier, or ends with an underscore";
    if (is_taken_prefix(t.prefix))
        return who + ": its prefix " + quote(t.prefix) + " is reserved: functions around it begin with it";
    if (const std::string problem = check_params(t.params); !problem.empty()) return who + ": " + problem;
    constexpr std::size_t most_operands = 16; // bits in the first word of an operation, render/texture_program.hpp
    std::size_t operands = 0;
    for (const model::Param& p : t.params) {
        const std::string param = who + ": parameter " + quote(p.id);
        if (p.type > ParamType::text) return param + ": a texture may have only numbers, colours, choices and texts";
        if (p.id == "average" || (t.image && p.id == "image") ||
            (t.mapped && find_param(model::mapping_params(), p.id)))
            return param + " is reserved for the host";
        operands += p.texturable;
    }
    if (operands > most_operands)
        return who + ": " + std::to_string(operands) + " texturable parameters; the maximum is 16";
    return check_glsl(t.glsl_file, folder, who);
}

std::string check_importer(const model::Importer& t) {
    if (const std::string problem = check_format("importer", t.format, t.label, t.extensions); !problem.empty())
        return problem;
    if (const std::string problem = check_params(t.options); !problem.empty())
        return "importer " + quote(t.format) + ": option table: " + problem;
    return "";
}

std::string check_exporter(const model::Exporter& t) {
    if (const std::string problem = check_format("exporter", t.format, t.label, t.extensions); !problem.empty())
        return problem;
    if (const std::string problem = check_params(t.options); !problem.empty())
        return "exporter " + quote(t.format) + ": option table: " + problem;
    return "";
}

namespace {

// For an action or a panel: its parameters never reach GLSL, and it has no table files.
std::string check_tool(const std::string& what, const std::string& id, const std::string& label,
                       model::ParamTable params) {
    if (!is_type_name(id)) return what + " without a proper id (lower case, digits, _)";
    const std::string who = what + " " + quote(id);
    if (label.empty()) return who + " has no label";
    if (const std::string problem = check_params(params); !problem.empty()) return who + ": " + problem;
    for (const model::Param& p : params)
        if (p.texturable || p.type == ParamType::table)
            return who + ": parameter " + quote(p.id) + ": it may be neither texturable nor a TABLE";
    return "";
}

} // namespace

std::string check_action(const model::Action& a) { return check_tool("action", a.id, a.label, a.params); }

std::string check_panel(const model::Panel& p) {
    const std::string problem = check_tool("panel", p.id, p.label, p.params);
    if (!problem.empty()) return problem;
    for (const model::Param& line : p.params)
        if (line.type == ParamType::material || line.type == ParamType::texture)
            return "panel " + quote(p.id) + ": parameter " + quote(line.id) +
                   ": a panel cannot refer to things of a document (MATERIAL, TEXTURE)";
    return "";
}

std::string check_sky(const model::Sky& s) {
    if (!is_type_name(s.type)) return "a sky without a proper type name (lower case, digits, _)";
    const std::string who = "sky " + quote(s.type);
    if (s.label.empty()) return who + " has no label";
    if (const std::string problem = check_params(s.params); !problem.empty()) return who + ": " + problem;
    for (const model::Param& p : s.params)
        if (p.texturable || p.type == ParamType::texture || p.type == ParamType::material || p.type == ParamType::table)
            return who + ": parameter " + quote(p.id) + ": a sky may not have textures, materials or tables";
    return "";
}

bool has_table(const model::Material& m) {
    return std::any_of(m.params.begin(), m.params.end(),
                       [](const model::Param& p) { return p.type == ParamType::table; });
}

} // namespace restage::plugin

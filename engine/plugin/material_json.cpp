// SPDX-License-Identifier: Apache-2.0
// Material tables written as JSON: the same lines as RestageMaterial1 and RestageParam, by name. Whether they make
// sense is asked by check_material, as for tables that come from a library.
#include "base/json.hpp"
#include "plugin/manifest_keys.hpp"
#include "plugin/material_source.hpp"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

namespace restage::plugin {

using nlohmann::json;

namespace {

using model::ParamType;

template <class T>
struct Word {
    const char* name;
    T value;
};
constexpr Word<ParamType> type_words[] = {{"float", ParamType::number}, {"color", ParamType::color},
                                          {"int", ParamType::integer},  {"bool", ParamType::boolean},
                                          {"enum", ParamType::choice},  {"text", ParamType::text}};
constexpr Word<bool model::Material::*> flag_words[] = {{"stochastic", &model::Material::stochastic},
                                                        {"lossless", &model::Material::lossless},
                                                        {"transmissive", &model::Material::transmissive},
                                                        {"nonreciprocal", &model::Material::nonreciprocal},
                                                        {"tangent", &model::Material::tangent},
                                                        {"additive", &model::Material::additive},
                                                        {"site", &model::Material::site}};
constexpr Word<bool model::Param::*> param_flag_words[] = {{"texturable", &model::Param::texturable},
                                                           {"advanced", &model::Param::advanced}};

// The value of a word, or the sentence that lists what there is.
template <class T, std::size_t n>
Result<T> look_up(const Word<T> (&words)[n], const std::string& name, const std::string& where) {
    std::string known;
    for (const Word<T>& word : words) {
        if (name == word.name) return word.value;
        known += (known.empty() ? "" : ", ") + std::string(word.name);
    }
    return fail(where + ": \"" + name + "\" is unknown; known are " + known);
}

// Every key is known: a typing error is not passed over.
Result<> know(const json& object, std::initializer_list<std::string_view> keys, const std::string& where) {
    if (!object.is_object()) return fail(where + " must be an object { ... }");
    const Keys known(keys.begin(), keys.end());
    if (const auto key = unknown_key(object, known)) return fail(where + ": " + unknown_key_text(*key, known));
    return {};
}
    // `otherwise`: where the key is not there; null: it must be.
Result<std::string> text(const json& object, const char* key, const char* otherwise, const std::string& where) {
    const auto it = object.find(key);
    if (it == object.end()) {
        if (otherwise) return std::string(otherwise);
        return fail(where + ": \"" + key + "\" is missing");
    }
    if (!it->is_string()) return fail(where + ": \"" + key + "\" must be a text");
    return it->get<std::string>();
}
Result<float> number(const json& object, const char* key, float otherwise, const std::string& where) {
    const auto it = object.find(key);
    if (it == object.end()) return otherwise;
    if (!it->is_number()) return fail(where + ": \"" + key + "\" must be a number");
    return it->get<float>();
}
Result<int> integer(const json& value, const std::string& where) {
    if (!value.is_number_integer() || value.get<std::int64_t>() < std::numeric_limits<int>::min() ||
        value.get<std::int64_t>() > std::numeric_limits<int>::max())
        return fail(where + " must be a whole number");
    return value.get<int>();
}
template <class T, std::size_t n>
Result<> flags(const json& object, const Word<bool T::*> (&words)[n], const std::string& where, T& out) {
    const auto it = object.find("flags");
    if (it == object.end()) return {};
    if (!it->is_array()) return fail(where + ": \"flags\" must be a list of words");
    for (const json& word : *it) {
        if (!word.is_string()) return fail(where + ": \"flags\" must be a list of words");
        RESTAGE_TRY(const auto flag, look_up(words, word.get<std::string>(), where + ": \"flags\""));
        out.*flag = true;
    }
    return {};
}

Result<> param_default(const json& value, const std::string& where, model::Param& p) {
    switch (p.type) {
        case ParamType::choice: {
            const auto index = value.is_string() ? p.choice_index(value.get<std::string>()) : std::nullopt;
            if (!index) return fail(where + " must be one of the choices");
            p.int_def = *index;
            return {};
        }
        case ParamType::boolean:
            if (!value.is_boolean()) return fail(where + " must be true or false");
            p.int_def = value.get<bool>();
            return {};
        case ParamType::integer: {
            RESTAGE_TRY(p.int_def, integer(value, where));
            return {};
        }
        case ParamType::color: {
            const bool three = value.is_array() && value.size() == 3 &&
                               std::all_of(value.begin(), value.end(), [](const json& v) { return v.is_number(); });
            if (!three) return fail(where + " must be three numbers [red, green, blue]");
            for (std::size_t i = 0; i < 3; ++i)
                p.def[i] = value[i].get<float>();
            return {};
        }
        case ParamType::number:
            if (!value.is_number()) return fail(where + " must be a number");
            p.def[0] = value.get<float>();
            return {};
        default: // a text has none
            return {};
    }
}

Result<model::Param> param(const json& object, const std::string& where) {
    RESTAGE_CHECK(
        know(object, {"id", "label", "type", "flags", "min", "max", "default", "unit", "choices", "tooltip"}, where));
    model::Param p;
    RESTAGE_TRY(p.id, text(object, "id", nullptr, where));
    RESTAGE_TRY(p.label, text(object, "label", p.id.c_str(), where));
    RESTAGE_TRY(const std::string type, text(object, "type", nullptr, where));
    if (type == "table")
        return fail(where + ": a table is read by native code (restage/table.h), which this material does not have");
    RESTAGE_TRY(p.type, look_up(type_words, type, where + ": \"type\""));
    RESTAGE_CHECK(flags(object, param_flag_words, where, p));
    if (p.type == ParamType::integer) {
        p.int_max = 1;
        for (const auto& [key, to] : {std::pair("min", &p.int_min), std::pair("max", &p.int_max)})
            if (const auto it = object.find(key); it != object.end()) {
                RESTAGE_TRY(*to, integer(*it, where + ": \"" + key + "\""));
            }
    } else {
        RESTAGE_TRY(p.min, number(object, "min", 0, where));
        RESTAGE_TRY(p.max, number(object, "max", 1, where));
    }
    RESTAGE_TRY(p.unit, text(object, "unit", "", where));
    RESTAGE_TRY(p.tooltip, text(object, "tooltip", "", where));
    if (const auto it = object.find("choices"); it != object.end()) {
        if (!it->is_array() || p.type != ParamType::choice)
            return fail(where + ": \"choices\" is a list of words, of an enum");
        for (const json& word : *it) {
            if (!word.is_string()) return fail(where + ": \"choices\" must be a list of words");
            p.choices.push_back(word.get<std::string>());
        }
    }
    if (const auto it = object.find("default"); it != object.end())
        RESTAGE_CHECK(param_default(*it, where + ": \"default\"", p));
    return p;
}

Result<model::Emission> emission(const json& object, const std::string& where) {
    RESTAGE_CHECK(know(object, {"radiance", "scale", "two_sided"}, where));
    model::Emission e;
    RESTAGE_TRY(e.radiance, text(object, "radiance", nullptr, where));
    RESTAGE_TRY(e.scale, text(object, "scale", "", where));
    RESTAGE_TRY(e.two_sided, text(object, "two_sided", "", where));
    return e;
}

Result<model::Material> material(const json& object, const std::string& where) {
    RESTAGE_CHECK(know(object, {"type", "label", "prefix", "glsl", "flags", "tooltip", "params", "emission"}, where));
    model::Material m;
    RESTAGE_TRY(m.type, text(object, "type", nullptr, where));
    RESTAGE_TRY(m.label, text(object, "label", m.type.c_str(), where));
    RESTAGE_TRY(m.prefix, text(object, "prefix", m.type.c_str(), where));
    RESTAGE_TRY(m.glsl_file, text(object, "glsl", nullptr, where));
    RESTAGE_CHECK(flags(object, flag_words, where, m));
    RESTAGE_TRY(m.tooltip, text(object, "tooltip", "", where));
    if (const auto it = object.find("params"); it != object.end()) {
        if (!it->is_array()) return fail(where + ": \"params\" must be a list");
        for (const json& line : *it) {
            RESTAGE_TRY(model::Param p, param(line, where + ".\"params\"[" + std::to_string(m.params.size()) + "]"));
            m.params.push_back(std::move(p));
        }
    }
    if (const auto it = object.find("emission"); it != object.end()) {
        RESTAGE_TRY(m.emission, emission(*it, where + ".\"emission\""));
    }
    return m;
}

} // namespace

Result<std::vector<model::Material>> parse_materials(const std::string& text, const std::string& file) {
    const json manifest = parse_json<json>(text).value_or(json());
    const auto it = manifest.is_object() ? manifest.find("materials") : manifest.end();
    if (!manifest.is_object() || it == manifest.end() || !it->is_array() || it->empty())
        return fail(file + ": \"materials\" must be a list of at least one material");
    std::vector<model::Material> list;
    for (const json& object : *it) {
        RESTAGE_TRY(model::Material m, material(object, file + ": \"materials\"[" + std::to_string(list.size()) + "]"));
        list.push_back(std::move(m));
    }
    return list;
}

} // namespace restage::plugin

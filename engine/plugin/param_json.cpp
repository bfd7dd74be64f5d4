// SPDX-License-Identifier: Apache-2.0
#include "plugin/param_json.hpp"

#include "plugin/manifest_keys.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace restage::plugin {

using nlohmann::json;

namespace {

using model::ParamType;

constexpr Word<ParamType> type_words[] = {{"float", ParamType::number}, {"color", ParamType::color},
                                          {"int", ParamType::integer},  {"bool", ParamType::boolean},
                                          {"enum", ParamType::choice},  {"text", ParamType::text}};
constexpr Word<bool model::Param::*> param_flag_words[] = {{"texturable", &model::Param::texturable},
                                                           {"advanced", &model::Param::advanced}};

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
        default: // texts have no default
            return {};
    }
}

Result<model::Param> param(const json& object, const std::string& where) {
    RESTAGE_CHECK(
        know(object, {"id", "label", "type", "flags", "min", "max", "default", "unit", "choices", "tooltip"}, where));
    model::Param p;
    RESTAGE_TRY(p.id, json_text(object, "id", nullptr, where));
    RESTAGE_TRY(p.label, json_text(object, "label", p.id.c_str(), where));
    RESTAGE_TRY(const std::string type, json_text(object, "type", nullptr, where));
    if (type == "table")
        return fail(where +
                    ": a table parameter needs native code to read it (restage/table.h), which parameters in a "
                    "manifest do not have");
    RESTAGE_TRY(p.type, look_up(type_words, type, where + ": \"type\""));
    RESTAGE_CHECK(json_flags(object, param_flag_words, where, p));
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
    RESTAGE_TRY(p.unit, json_text(object, "unit", "", where));
    RESTAGE_TRY(p.tooltip, json_text(object, "tooltip", "", where));
    if (const auto it = object.find("choices"); it != object.end()) {
        if (!it->is_array() || p.type != ParamType::choice)
            return fail(where + ": \"choices\" is only for an enum, a list of words");
        for (const json& word : *it) {
            if (!word.is_string()) return fail(where + ": \"choices\" must be a list of words");
            p.choices.push_back(word.get<std::string>());
        }
    }
    if (const auto it = object.find("default"); it != object.end())
        RESTAGE_CHECK(param_default(*it, where + ": \"default\"", p));
    return p;
}

} // namespace

Result<> know(const json& object, std::initializer_list<std::string_view> keys, const std::string& where) {
    if (!object.is_object()) return fail(where + " must be an object { ... }");
    const Keys known(keys.begin(), keys.end());
    if (const auto key = unknown_key(object, known)) return fail(where + ": " + unknown_key_text(*key, known));
    return {};
}
Result<std::string> json_text(const json& object, const char* key, const char* otherwise, const std::string& where) {
    const auto it = object.find(key);
    if (it == object.end()) {
        if (otherwise) return std::string(otherwise);
        return fail(where + ": \"" + key + "\" is missing");
    }
    if (!it->is_string()) return fail(where + ": \"" + key + "\" must be a text");
    return it->get<std::string>();
}

Result<std::vector<model::Param>> json_params(const json& object, const std::string& where) {
    std::vector<model::Param> list;
    const auto it = object.find("params");
    if (it == object.end()) return list;
    if (!it->is_array()) return fail(where + ": \"params\" must be a list");
    for (const json& line : *it) {
        RESTAGE_TRY(model::Param p, param(line, where + ".\"params\"[" + std::to_string(list.size()) + "]"));
        list.push_back(std::move(p));
    }
    return list;
}

} // namespace restage::plugin

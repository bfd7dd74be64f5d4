// SPDX-License-Identifier: Apache-2.0
// Material tables written as JSON: the same lines as RestageMaterial1 and RestageParam, by name. Whether they make
// sense is asked by check_table, as for tables that come from a library.
#include "base/json.hpp"
#include "plugin/manifest_keys.hpp"
#include "plugin/material_source.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace restage::plugin {

using nlohmann::json;

namespace {

struct Word {
    const char* name;
    std::uint32_t value;
};
constexpr Word type_words[] = {{"float", RESTAGE_FLOAT}, {"color", RESTAGE_COLOR}, {"int", RESTAGE_INT},
                               {"bool", RESTAGE_BOOL},   {"enum", RESTAGE_ENUM},   {"text", RESTAGE_TEXT}};
constexpr Word flag_words[] = {
    {"stochastic", RESTAGE_MATERIAL_STOCHASTIC},     {"lossless", RESTAGE_MATERIAL_LOSSLESS},
    {"transmissive", RESTAGE_MATERIAL_TRANSMISSIVE}, {"nonreciprocal", RESTAGE_MATERIAL_NONRECIPROCAL},
    {"tangent", RESTAGE_MATERIAL_TANGENT},           {"additive", RESTAGE_MATERIAL_ADDITIVE}};
constexpr Word param_flag_words[] = {{"texturable", RESTAGE_PARAM_TEXTURABLE}, {"advanced", RESTAGE_PARAM_ADVANCED}};

// The value of a word, or the sentence that lists what there is.
Result<std::uint32_t> look_up(std::span<const Word> words, const std::string& name, const std::string& where) {
    std::string known;
    for (const Word& word : words) {
        if (name == word.name) return word.value;
        known += (known.empty() ? "" : ", ") + std::string(word.name);
    }
    return fail(where + ": \"" + name + "\" is unknown; known are " + known);
}

} // namespace

struct JsonReader {
    JsonMaterials& out;

    // Every key is known: a typing error is not passed over.
    static Result<> know(const json& object, std::initializer_list<std::string_view> keys, const std::string& where) {
        if (!object.is_object()) return fail(where + " must be an object { ... }");
        const Keys known(keys.begin(), keys.end());
        if (const auto key = unknown_key(object, known)) return fail(where + ": " + unknown_key_text(*key, known));
        return {};
    }
    const char* keep(std::string text) { return out.strings_.emplace_back(std::move(text)).c_str(); }
    Result<const char*> text(const json& object, const char* key, const char* otherwise, const std::string& where) {
        const auto it = object.find(key);
        if (it == object.end()) {
            if (otherwise) return otherwise;
            return fail(where + ": \"" + key + "\" is missing");
        }
        if (!it->is_string()) return fail(where + ": \"" + key + "\" must be a text");
        return keep(it->get<std::string>());
    }
    static Result<float> number(const json& object, const char* key, float otherwise, const std::string& where) {
        const auto it = object.find(key);
        if (it == object.end()) return otherwise;
        if (!it->is_number()) return fail(where + ": \"" + key + "\" must be a number");
        return it->get<float>();
    }
    static Result<std::uint32_t> flags(const json& object, std::span<const Word> words, const std::string& where) {
        const auto it = object.find("flags");
        if (it == object.end()) return 0u;
        std::uint32_t result = 0;
        if (!it->is_array()) return fail(where + ": \"flags\" must be a list of words");
        for (const json& word : *it) {
            if (!word.is_string()) return fail(where + ": \"flags\" must be a list of words");
            RESTAGE_TRY(const std::uint32_t flag, look_up(words, word.get<std::string>(), where + ": \"flags\""));
            result |= flag;
        }
        return result;
    }

    Result<RestageParam> param(const json& object, const std::string& where) {
        RESTAGE_CHECK(know(
            object, {"id", "label", "type", "flags", "min", "max", "default", "unit", "choices", "tooltip"}, where));
        RestageParam p{};
        RESTAGE_TRY(p.id, text(object, "id", nullptr, where));
        RESTAGE_TRY(p.label, text(object, "label", p.id, where));
        RESTAGE_TRY(const char* type, text(object, "type", nullptr, where));
        if (std::string_view(type) == "table")
            return fail(where + ": a table is read by native code (restage/table.h), which this plugin does not have");
        RESTAGE_TRY(p.type, look_up(type_words, type, where + ": \"type\""));
        RESTAGE_TRY(p.flags, flags(object, param_flag_words, where));
        RESTAGE_TRY(p.min, number(object, "min", 0, where));
        RESTAGE_TRY(p.max, number(object, "max", 1, where));
        RESTAGE_TRY(p.unit, text(object, "unit", "", where));
        RESTAGE_TRY(p.tooltip, text(object, "tooltip", "", where));
        std::vector<std::string> choices;
        if (const auto it = object.find("choices"); it != object.end()) {
            std::string joined;
            if (!it->is_array() || p.type != RESTAGE_ENUM)
                return fail(where + ": \"choices\" is a list of words, of an enum");
            for (const json& word : *it) {
                if (!word.is_string()) return fail(where + ": \"choices\" must be a list of words");
                if (!choices.empty()) joined += '|';
                joined += choices.emplace_back(word.get<std::string>());
            }
            p.choices = keep(joined);
        }
        if (const auto it = object.find("default"); it != object.end()) {
            const std::string key = where + ": \"default\"";
            if (p.type == RESTAGE_ENUM) {
                const auto at =
                    it->is_string() ? std::find(choices.begin(), choices.end(), it->get<std::string>()) : choices.end();
                if (at == choices.end()) return fail(key + " must be one of the choices");
                p.def[0] = static_cast<float>(at - choices.begin());
            } else if (p.type == RESTAGE_BOOL) {
                if (!it->is_boolean()) return fail(key + " must be true or false");
                p.def[0] = it->get<bool>() ? 1.f : 0.f;
            } else if (p.type == RESTAGE_COLOR) {
                const bool three = it->is_array() && it->size() == 3 &&
                                   std::all_of(it->begin(), it->end(), [](const json& v) { return v.is_number(); });
                if (!three) return fail(key + " must be three numbers [red, green, blue]");
                for (std::size_t i = 0; i < 3; ++i)
                    p.def[i] = (*it)[i].get<float>();
            } else if (p.type != RESTAGE_TEXT) {
                if (!it->is_number()) return fail(key + " must be a number");
                p.def[0] = it->get<float>();
            }
        }
        return p;
    }

    Result<> emission(const json& object, const char* type, const std::string& where) {
        RESTAGE_CHECK(know(object, {"radiance", "scale", "two_sided"}, where));
        RestageEmission1 e{};
        e.size = sizeof e;
        e.type = type;
        RESTAGE_TRY(e.radiance, text(object, "radiance", nullptr, where));
        if (object.contains("scale")) {
            RESTAGE_TRY(e.scale, text(object, "scale", nullptr, where));
        }
        if (object.contains("two_sided")) {
            RESTAGE_TRY(e.two_sided, text(object, "two_sided", nullptr, where));
        }
        out.emissions_.push_back(e);
        return {};
    }

    Result<RestageMaterial1> material(const json& object, const std::string& where) {
        RESTAGE_CHECK(
            know(object, {"type", "label", "prefix", "glsl", "flags", "tooltip", "params", "emission"}, where));
        RestageMaterial1 m{};
        m.size = sizeof m;
        RESTAGE_TRY(m.type, text(object, "type", nullptr, where));
        RESTAGE_TRY(m.label, text(object, "label", m.type, where));
        RESTAGE_TRY(m.prefix, text(object, "prefix", m.type, where));
        RESTAGE_TRY(m.glsl_file, text(object, "glsl", nullptr, where));
        RESTAGE_TRY(m.flags, flags(object, flag_words, where));
        RESTAGE_TRY(m.tooltip, text(object, "tooltip", "", where));
        auto& params = out.params_.emplace_back();
        if (const auto it = object.find("params"); it != object.end()) {
            if (!it->is_array()) return fail(where + ": \"params\" must be a list");
            for (const json& line : *it) {
                RESTAGE_TRY(const RestageParam p,
                            param(line, where + ".\"params\"[" + std::to_string(params.size()) + "]"));
                params.push_back(p);
            }
        }
        m.params = params.data();
        m.param_count = static_cast<std::uint32_t>(params.size());
        if (const auto it = object.find("emission"); it != object.end())
            RESTAGE_CHECK(emission(*it, m.type, where + ".\"emission\""));
        return m;
    }
};

Result<std::unique_ptr<JsonMaterials>> JsonMaterials::parse(const std::string& text, const std::string& file) {
    const json manifest = parse_json<json>(text).value_or(json());
    const auto it = manifest.is_object() ? manifest.find("materials") : manifest.end();
    if (!manifest.is_object() || it == manifest.end() || !it->is_array() || it->empty())
        return fail(file + ": \"materials\" must be a list of at least one material");
    auto made = std::make_unique<JsonMaterials>();
    JsonReader reader{*made};
    for (const json& object : *it) {
        RESTAGE_TRY(const RestageMaterial1 table,
                    reader.material(object, file + ": \"materials\"[" + std::to_string(made->tables_.size()) + "]"));
        made->tables_.push_back(table);
    }
    return made;
}

} // namespace restage::plugin

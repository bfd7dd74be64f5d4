// SPDX-License-Identifier: Apache-2.0
// Private to plugin/: the common part of materials' and textures' tables written as JSON. `where` begins every
// message: 'plugin.json: "materials"[0]'.
#pragma once

#include "base/json.hpp"
#include "base/result.hpp"
#include "model/param.hpp"

#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace restage::plugin {

template <class T>
struct Word {
    const char* name;
    T value;
};

// The value of a word, or an error that lists the known words.
template <class T, std::size_t n>
Result<T> look_up(const Word<T> (&words)[n], const std::string& name, const std::string& where) {
    std::string known;
    for (const Word<T>& word : words) {
        if (name == word.name) return word.value;
        known += (known.empty() ? "" : ", ") + std::string(word.name);
    }
    return fail(where + ": \"" + name + "\" is unknown; known: " + known);
}

// Checks that every key is known, so that misspellings are reported.
Result<> know(const nlohmann::json& object, std::initializer_list<std::string_view> keys, const std::string& where);
// `otherwise`: the value if the key is missing; null: it is required.
Result<std::string> json_text(const nlohmann::json& object, const char* key, const char* otherwise,
                              const std::string& where);

template <class T, std::size_t n>
Result<> json_flags(const nlohmann::json& object, const Word<bool T::*> (&words)[n], const std::string& where, T& out) {
    const auto it = object.find("flags");
    if (it == object.end()) return {};
    if (!it->is_array()) return fail(where + ": \"flags\" must be a list of words");
    for (const nlohmann::json& word : *it) {
        if (!word.is_string()) return fail(where + ": \"flags\" must be a list of words");
        RESTAGE_TRY(const auto flag, look_up(words, word.get<std::string>(), where + ": \"flags\""));
        out.*flag = true;
    }
    return {};
}

// "params" of the object; empty if it has none.
Result<std::vector<model::Param>> json_params(const nlohmann::json& object, const std::string& where);

// The keys that tables with GLSL have in common.
template <class T, std::size_t n>
Result<> json_shader(const nlohmann::json& object, const Word<bool T::*> (&flags)[n], const std::string& where,
                     T& out) {
    RESTAGE_TRY(out.type, json_text(object, "type", nullptr, where));
    RESTAGE_TRY(out.label, json_text(object, "label", out.type.c_str(), where));
    RESTAGE_TRY(out.prefix, json_text(object, "prefix", out.type.c_str(), where));
    RESTAGE_TRY(out.glsl_file, json_text(object, "glsl", nullptr, where));
    RESTAGE_CHECK(json_flags(object, flags, where, out));
    RESTAGE_TRY(out.tooltip, json_text(object, "tooltip", "", where));
    RESTAGE_TRY(out.params, json_params(object, where));
    return {};
}

// The tables of one kind in a manifest's text: each element of the list `key`, read by `read(object, where)`. Empty if
// there is no such key.
template <class Table, class Read>
Result<std::vector<Table>> json_tables(const std::string& text, const std::string& file, const std::string& key,
                                       Read&& read) {
    const nlohmann::json manifest = parse_json<nlohmann::json>(text).value_or(nlohmann::json());
    std::vector<Table> list;
    const auto it = manifest.is_object() ? manifest.find(key) : manifest.end();
    if (!manifest.is_object() || it == manifest.end()) return list;
    if (!it->is_array() || it->empty())
        return fail(file + ": \"" + key + "\" must be a list of at least one " + key.substr(0, key.size() - 1));
    for (const nlohmann::json& object : *it) {
        RESTAGE_TRY(Table t, read(object, file + ": \"" + key + "\"[" + std::to_string(list.size()) + "]"));
        list.push_back(std::move(t));
    }
    return list;
}

} // namespace restage::plugin

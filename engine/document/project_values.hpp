// SPDX-License-Identifier: Apache-2.0
// Reading values of a project file: references by id and name, fields by name; unknown members are set
// aside. The inverse of the writer's to_json().
#pragma once

#include "document/project_fields.hpp"
#include "document/project_json.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace restage::document {

struct Ref {
    std::uint32_t number = 0;
    std::string name;
};

inline std::optional<Ref> parse_ref(const json& j) { // "#17 oak"
    if (!j.is_string()) return std::nullopt;
    const std::string& text = j.get_ref<const std::string&>();
    Ref ref;
    if (!text.starts_with('#')) return std::nullopt;
    const auto [end, code] = std::from_chars(text.data() + 1, text.data() + text.size(), ref.number);
    if (code != std::errc() || ref.number == 0) return std::nullopt;
    if (end != text.data() + text.size()) ref.name.assign(end + 1, text.data() + text.size());
    return ref;
}

class ValueReader {
  public:
    explicit ValueReader(std::string file)
        : file_(std::move(file)), folder_(std::filesystem::absolute(file_).parent_path()) {}

    // As a visitor of fields().
    template <class T>
    void operator()(const char* name, T& value) {
        if constexpr (std::is_same_v<T, scene::ParamSet>)
            if (std::string_view(name) != "params" && in_->contains(name)) value = {}; // written whole
        if (const json* j = member(name)) read(*j, value, name);
        if constexpr (std::is_same_v<T, scene::ParamSet>)
            if (const json* all = member("all_params")) {
                value = {};
                read(*all, value, "all_params");
            }
    }

  protected:
    template <class T>
    std::optional<scene::Id<T>> resolve(const json& j, const char* field) {
        const auto ref = parse_ref(j);
        if (!ref) {
            error(field, "expected a reference like \"#17 oak\"");
            return std::nullopt;
        }
        const auto& base = scene::table<T>(*base_);
        const std::uint32_t old = sizes_[scene::kind_name<T>];
        if (ref->number > old) return scene::Id<T>{base.size() + (ref->number - old)};
        const T* item = base.find({ref->number});
        if (item && item->name == ref->name) return scene::Id<T>{ref->number};
        if (const scene::Id<T> id = scene::find_by_name<T>(*base_, ref->name)) return id;
        lost_.push_back(fmt::format("{} \"{}\"", scene::kind_name<T>, ref->name));
        return std::nullopt;
    }

    const json* member(const char* name) {
        seen_.insert(name);
        const auto found = in_->find(name);
        return found == in_->end() ? nullptr : &*found;
    }
    void error(const char* field, const std::string& what) {
        if (error_.empty()) error_ = fmt::format("{}: {}: {}: {}", file_, where_, field, what);
    }
    void read(const json& j, std::string& s, const char* field) {
        if (j.is_string())
            s = j.get<std::string>();
        else
            error(field, "expected text");
    }
    void read(const json& j, bool& b, const char* field) {
        if (j.is_boolean())
            b = j.get<bool>();
        else
            error(field, "expected true or false");
    }
    void read(const json& j, std::uint32_t& n, const char* field) {
        if (j.is_number_unsigned())
            n = j.get<std::uint32_t>();
        else
            error(field, "expected a whole number");
    }
    template <class F>
        requires std::is_floating_point_v<F>
    void read(const json& j, F& x, const char* field) {
        if (!read_number(j, x)) error(field, "expected a number");
    }
    template <int N, class T>
    void read(const json& j, glm::vec<N, T>& v, const char* field) {
        if (!j.is_array() || j.size() != N) return error(field, fmt::format("expected {} numbers", N));
        for (int i = 0; i < N; ++i)
            read(j[std::size_t(i)], v[i], field);
    }
    void read(const json& j, glm::dmat4& m, const char* field) {
        if (!j.is_array() || j.size() != 4) return error(field, "expected four columns of four numbers");
        for (int c = 0; c < 4; ++c)
            read(j[std::size_t(c)], m[c], field);
    }
    template <class T>
    void read(const json& j, scene::Id<T>& id, const char* field) {
        if (j.is_null())
            id = {};
        else if (const auto found = resolve<T>(j, field))
            id = *found;
    }
    template <class E>
        requires std::is_enum_v<E>
    void read(const json& j, E& e, const char* field) {
        for (std::size_t i = 0; i < std::size(Names<E>::list); ++i)
            if (j == Names<E>::list[i]) {
                e = static_cast<E>(int(i) + Names<E>::first);
                return;
            }
        error(field, j.dump() + " is unknown");
    }
    template <class T>
    void read(const json& j, std::optional<T>& x, const char* field) {
        if (j.is_null()) {
            x.reset();
            return;
        }
        if (!x) x.emplace();
        read(j, *x, field);
    }
    template <class T>
        requires std::is_class_v<T>
    void read(const json& j, T& item, const char* field) {
        json ignored;
        json* const place = unknown_ ? unknown_ : &ignored;
        json below = json::object();
        read_members(*this, j, item, field, below);
        if (!below.empty()) (*place)[field] = std::move(below);
    }
    void read(const json& j, scene::Value& v, const char* field) {
        v = {};
        if (j.is_number()) return void(v.v[0] = j.get<float>());
        if (j.is_boolean()) {
            v.type = model::ParamType::boolean;
            v.i = j.get<bool>();
        } else if (j.is_array() && j.size() == 3) {
            v.type = model::ParamType::color;
            for (std::size_t i = 0; i < 3; ++i)
                read(j[i], v.v[i], field);
        } else if (j.is_object()) {
            const auto type = j.find("type");
            const auto known = std::find_if(std::begin(type_names), std::end(type_names),
                                            [&](const char* name) { return type != j.end() && *type == name; });
            if (known == std::end(type_names)) return error(field, "the type of the value is unknown");
            v.type = static_cast<model::ParamType>(known - std::begin(type_names));
            if (const auto list = j.find("v"); list != j.end() && list->is_array())
                for (std::size_t i = 0; i < std::min<std::size_t>(list->size(), 4); ++i)
                    read((*list)[i], v.v[i], field);
            if (v.is_whole()) { // whole numbers may replace others
                v.i = static_cast<int>(std::clamp(v.v[0], -2147483520.f, 2147483520.f));
                if (const auto list = j.find("v"); list != j.end() && list->is_array() && !list->empty())
                    if ((*list)[0].is_number_integer()) v.i = (*list)[0].get<int>();
                v.v = {};
            }
            if (const auto path = j.find("file"); path != j.end()) { // of a table
                read(*path, v.text, field);
                if (!v.text.empty()) v.text = (folder_ / v.text).lexically_normal().string();
            }
            if (const auto text = j.find("text"); text != j.end()) read(*text, v.text, field);
            if (const auto texture = j.find("texture"); texture != j.end()) read(*texture, v.texture, field);
            if (const auto material = j.find("material"); material != j.end()) read(*material, v.material, field);
        } else if (float x = 0; read_number(j, x)) { // "inf"
            v.v[0] = x;
        } else if (j.is_string()) {
            v.type = model::ParamType::text;
            v.text = j.get<std::string>();
        } else
            error(field, "expected a value");
    }
    void read(const json& j, std::vector<scene::OriginValue>& list, const char* field) {
        list.clear();
        if (!j.is_array()) return error(field, "expected a list");
        for (const json& pair : j) {
            if (!pair.is_array() || pair.size() != 2 || !pair[0].is_string() || !pair[1].is_string())
                return error(field, "expected pairs of texts");
            list.push_back({pair[0].get<std::string>(), pair[1].get<std::string>()});
        }
    }
    void read(const json& j, scene::ParamSet& params, const char* field) {
        if (!j.is_object()) return error(field, "expected values by name");
        for (const auto& [id, value] : j.items()) {
            if (value.is_null()) {
                params.remove(id);
                continue;
            }
            scene::Value v;
            read(value, v, id.c_str());
            params.set(id, std::move(v));
        }
    }

    template <class V, class T>
    void read_members(V& visitor, const json& j, T& item, const char* field, json& unknown) {
        if (!j.is_object()) return error(field, "expected an object");
        const json* const outer = std::exchange(in_, &j);
        json* const outer_unknown = std::exchange(unknown_, &unknown);
        std::set<std::string> outer_seen = std::exchange(seen_, {});
        fields(visitor, item);
        for (const auto& [key, value] : j.items())
            if (!seen_.contains(key)) unknown[key] = value;
        if (!unknown.empty()) unknown[place_mark] = true;
        seen_ = std::move(outer_seen);
        unknown_ = outer_unknown;
        in_ = outer;
    }

    const std::string file_;
    const std::filesystem::path folder_; // paths in the file are relative to it
    const scene::Scene* base_ = nullptr;
    std::map<std::string, std::uint32_t> sizes_; // of the base when the project was saved, by kind
    std::vector<std::string> lost_;              // items missing from the base
    std::string error_, where_;                  // the first one
    const json* in_ = nullptr;
    json* unknown_ = nullptr;
    std::set<std::string> seen_;
};

} // namespace restage::document

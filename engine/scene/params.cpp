// SPDX-License-Identifier: Apache-2.0
#include "scene/params.hpp"

#include <algorithm>

namespace restage::scene {

const Value* ParamSet::find(std::string_view id) const {
    const auto it = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.id == id; });
    return it == entries_.end() ? nullptr : &it->value;
}

void ParamSet::set(std::string_view id, Value value) {
    const auto it = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.id == id; });
    if (it != entries_.end())
        it->value = std::move(value);
    else
        entries_.push_back({std::string(id), std::move(value)});
}

void ParamSet::remove(std::string_view id) {
    std::erase_if(entries_, [&](const Entry& e) { return e.id == id; });
}

float ParamSet::number(std::string_view id, float fallback) const {
    const Value* value = find(id);
    return value ? value->v[0] : fallback;
}

std::string_view ParamSet::choice(std::string_view id, std::string_view fallback) const {
    const Value* value = find(id);
    return value ? std::string_view(value->text) : fallback;
}

std::array<float, 3> ParamSet::color(std::string_view id, std::array<float, 3> fallback) const {
    const Value* value = find(id);
    return value ? std::array{value->v[0], value->v[1], value->v[2]} : fallback;
}

Id<Texture> ParamSet::texture(std::string_view id) const {
    const Value* value = find(id);
    return value ? value->texture : Id<Texture>{};
}

Value default_value(const RestageParam& param) {
    Value value;
    value.type = static_cast<RestageType>(param.type);
    switch (value.type) {
        case RESTAGE_FLOAT:
        case RESTAGE_INT:
        case RESTAGE_BOOL:
            value.v[0] = param.def[0];
            break;
        case RESTAGE_COLOR:
            std::copy_n(param.def, 3, value.v.begin());
            break;
        case RESTAGE_ENUM: {
            std::string_view rest = param.choices ? param.choices : "";
            for (int i = static_cast<int>(param.def[0]); i > 0; --i)
                rest.remove_prefix(std::min(rest.find('|'), rest.size() - 1) + 1);
            value.text = rest.substr(0, rest.find('|'));
            break;
        }
        case RESTAGE_TABLE:
            value.text = param.choices ? param.choices : "";
            break;
        case RESTAGE_TEXT:
        case RESTAGE_MATERIAL:
        case RESTAGE_TEXTURE:
            break;
    }
    return value;
}

std::optional<int> choice_index(std::string_view choices, std::string_view choice) {
    for (int i = 0;; ++i) {
        const std::size_t bar = choices.find('|');
        if (choices.substr(0, bar) == choice) return i;
        if (bar == std::string_view::npos) return std::nullopt;
        choices.remove_prefix(bar + 1);
    }
}

} // namespace restage::scene

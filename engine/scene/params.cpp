// SPDX-License-Identifier: Apache-2.0
#include "scene/params.hpp"

#include <fmt/format.h>
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
    return value ? value->scalar() : fallback;
}

int ParamSet::integer(std::string_view id, int fallback) const {
    const Value* value = find(id);
    return value ? value->whole() : fallback;
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

Value default_value(const model::Param& param) {
    Value value;
    value.type = param.type;
    switch (param.type) {
        case ParamType::number:
            value.v[0] = param.def[0];
            break;
        case ParamType::color:
            std::copy_n(param.def.begin(), 3, value.v.begin());
            break;
        case ParamType::integer:
        case ParamType::boolean:
            value.i = param.int_def;
            break;
        case ParamType::choice:
            if (param.int_def >= 0 && std::size_t(param.int_def) < param.choices.size())
                value.text = param.choices[std::size_t(param.int_def)];
            break;
        case ParamType::table:
            value.text = param.file;
            break;
        case ParamType::text:
        case ParamType::material:
        case ParamType::texture:
            break;
    }
    return value;
}

std::string misfit(const model::Param& line, const Value& value) {
    if (line.type != value.type) return " has a different type";
    if (value.texture && !line.texturable && line.type != ParamType::texture) return " takes no texture";
    if (value.texture) return "";
    if (line.type == ParamType::choice && !line.choice_index(value.text))
        return " cannot be \"" + value.text + "\"; " + choices_text(line) + " are possible";
    if (line.type == ParamType::integer && (value.i < line.int_min || value.i > line.int_max))
        return fmt::format(": {} is out of its range, {} to {}", value.i, line.int_min, line.int_max);
    if (line.type == ParamType::number || line.type == ParamType::color)
        for (std::size_t k = 0; k < std::size_t(line.components()); ++k)
            if (!(value.v[k] >= line.min && value.v[k] <= line.max))
                return fmt::format(": {:f} is out of its range, {:f} to {:f}", value.v[k], line.min, line.max);
    return "";
}

} // namespace restage::scene

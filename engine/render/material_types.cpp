// SPDX-License-Identifier: Apache-2.0
#include "render/material_types.hpp"

#include <algorithm>
#include <bit>

namespace restage::render {

MaterialLookup material_lookup(const plugin::Registry& registry) {
    return [&registry](const std::string& type) -> std::optional<MaterialPlugin> {
        const auto entry = registry.find_material(type);
        if (!entry) return std::nullopt;
        return MaterialPlugin{entry->table, entry->plugin->folder, entry->source, entry->blame};
    };
}

std::uint32_t value_words(const RestageParam& p) {
    switch (p.type) {
        case RESTAGE_COLOR:
        case RESTAGE_TABLE: // address, size
            return 3;
        case RESTAGE_FLOAT:
        case RESTAGE_INT:
        case RESTAGE_BOOL:
        case RESTAGE_ENUM:
            return 1;
        default:
            return 0; // TEXT, MATERIAL, TEXTURE: not for BSDFs
    }
}

std::string table_path(const RestageParam& line, const scene::ParamSet& params) {
    const scene::Value* set = params.find(line.id);
    return set && set->type == RESTAGE_TABLE ? set->text : scene::default_value(line).text;
}

std::vector<std::uint32_t> pack_material(const RestageMaterial1& table, const scene::ParamSet& params,
                                         std::span<const DeviceTable> tables) {
    std::vector<std::uint32_t> words;
    std::size_t next_table = 0;
    for (std::uint32_t i = 0; i < table.param_count; ++i) {
        const RestageParam& line = table.params[i];
        const auto n = value_words(line);
        if (n == 0) continue;
        const scene::Value* set = params.find(line.id);
        const scene::Value value = set ? *set : scene::default_value(line);
        switch (line.type) {
            case RESTAGE_COLOR:
                for (int k = 0; k < 3; ++k) // a number where a colour is asked for is a grey
                    words.push_back(
                        std::bit_cast<std::uint32_t>(value.type == RESTAGE_FLOAT ? value.v[0] : value.v[k]));
                break;
            case RESTAGE_FLOAT:
                words.push_back(std::bit_cast<std::uint32_t>(value.v[0]));
                break;
            case RESTAGE_TABLE: {
                const DeviceTable t = next_table < tables.size() ? tables[next_table] : DeviceTable{};
                ++next_table;
                words.push_back(std::uint32_t(t.address));
                words.push_back(std::uint32_t(t.address >> 32));
                words.push_back(t.size);
                break;
            }
            case RESTAGE_ENUM: {
                const auto index = scene::choice_index(line.choices, value.text);
                words.push_back(std::uint32_t(index ? *index : int(line.def[0])));
                break;
            }
            default:
                words.push_back(std::uint32_t(std::int32_t(value.v[0])));
        }
        if (line.flags & RESTAGE_PARAM_TEXTURABLE) words.push_back(value.texture.value);
    }
    return words;
}

std::string word_layout(const RestageMaterial1* table) {
    std::string layout;
    for (std::uint32_t i = 0; table && i < table->param_count; ++i)
        layout += " " + std::to_string(value_words(table->params[i])) + "+" +
                  std::to_string(line_words(table->params[i]) - value_words(table->params[i])) +
                  (table->params[i].type == RESTAGE_TABLE ? "t" : ""); // no number is taken for an address
    return layout;
}

std::array<std::uint32_t, 3> stand_in_color(const RestageMaterial1& table, const scene::ParamSet& params,
                                            const RestageEmission1* emission) {
    scene::Value color = scene::Value::color(.5f, .5f, .5f);
    for (std::uint32_t i = 0; i < table.param_count; ++i) {
        const RestageParam& line = table.params[i];
        if (line.type != RESTAGE_COLOR || line.max != 1) continue;
        if (emission && std::string_view(emission->radiance) == line.id) continue;
        const scene::Value* set = params.find(line.id);
        color = set && !set->texture ? *set : scene::default_value(line); // beside a texture the number says nothing
        break;
    }
    std::array<std::uint32_t, 3> words{};
    for (std::size_t k = 0; k < 3; ++k) {
        const float v = color.v[color.type == RESTAGE_FLOAT ? 0 : k];
        words[k] = std::bit_cast<std::uint32_t>(v > 0 ? std::min(v, 0.9f) : 0.f);
    }
    return words;
}

} // namespace restage::render

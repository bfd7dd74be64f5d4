// SPDX-License-Identifier: Apache-2.0
#include "render/material_types.hpp"

#include <algorithm>
#include <bit>

namespace restage::render {

bool MaterialType::may_be_specular() const {
    if (!plugin.table || !plugin.table->has_code()) return false;
    if (!plugin.source) return true;
    return std::ranges::any_of(*plugin.source->glsl(), [](const auto& file) {
        return file.second.find("BSDF_DELTA") != std::string::npos ||
               file.second.find("layered.glsl") != std::string::npos;
    });
}

MaterialLookup material_lookup(const plugin::Registry& registry) {
    return {[&registry](const std::string& type) -> std::optional<MaterialPlugin> {
                const auto entry = registry.find_material(type);
                if (!entry) return std::nullopt;
                return MaterialPlugin{entry->table, entry->plugin->folder, entry->source, entry->blame};
            },
            texture_lookup(registry)};
}

std::uint32_t value_words(const model::Param& p) {
    switch (p.type) {
        case model::ParamType::color:
        case model::ParamType::table: // address, size
            return 3;
        case model::ParamType::number:
        case model::ParamType::integer:
        case model::ParamType::boolean:
        case model::ParamType::choice:
            return 1;
        default:
            return 0; // TEXT, MATERIAL, TEXTURE: not for BSDFs
    }
}

std::string table_path(const model::Param& line, const scene::ParamSet& params) {
    const scene::Value* set = params.find(line.id);
    return set && set->type == model::ParamType::table ? set->text : scene::default_value(line).text;
}

void pack_value(const model::Param& line, const scene::ParamSet& params, std::vector<std::uint32_t>& words,
                DeviceTable table, const ValueStore* store) {
    if (value_words(line) == 0) return;
    const scene::Value* set = params.find(line.id);
    const scene::Value value = set ? *set : scene::default_value(line);
    switch (line.type) {
        case model::ParamType::color: {
            glm::vec3 c(value.scalar()); // a number used as a colour is grey
            if (value.type == model::ParamType::color) c = {value.v[0], value.v[1], value.v[2]};
            if (store) c = store->color(line, c);
            for (int k = 0; k < 3; ++k)
                words.push_back(std::bit_cast<std::uint32_t>(c[k]));
            break;
        }
        case model::ParamType::number:
            words.push_back(store ? store->number(line, value.scalar()) : std::bit_cast<std::uint32_t>(value.scalar()));
            break;
        case model::ParamType::table:
            words.push_back(std::uint32_t(table.address));
            words.push_back(std::uint32_t(table.address >> 32));
            words.push_back(table.size);
            break;
        case model::ParamType::choice: {
            const auto index = line.choice_index(value.text);
            words.push_back(std::uint32_t(index ? *index : line.int_def));
            break;
        }
        default:
            words.push_back(std::uint32_t(value.whole()));
    }
}

std::vector<std::uint32_t> pack_material(const model::Material& table, const scene::ParamSet& params,
                                         std::span<const DeviceTable> tables, const ValueStore* store) {
    std::vector<std::uint32_t> words;
    std::size_t next_table = 0;
    for (const model::Param& line : table.params) {
        if (value_words(line) == 0) continue;
        const bool reads = line.type == model::ParamType::table;
        pack_value(line, params, words, reads && next_table < tables.size() ? tables[next_table] : DeviceTable{},
                   store);
        next_table += reads;
        if (line.texturable) words.push_back(params.texture(line.id).value);
    }
    return words;
}

std::string word_layout(const model::Material* table) {
    std::string layout;
    for (const model::Param& line : table ? model::ParamTable(table->params) : model::ParamTable())
        layout += " " + std::to_string(value_words(line)) + "+" + std::to_string(line_words(line) - value_words(line)) +
                  (line.type == model::ParamType::table ? "t" : ""); // keeps numbers from being read as addresses
    return layout;
}

glm::vec3 stand_in_color(const model::Material& table, const scene::ParamSet& params) {
    scene::Value color = scene::Value::color(.5f, .5f, .5f);
    for (const model::Param& line : table.params) {
        if (line.type != model::ParamType::color || line.max != 1) continue;
        if (table.emission && table.emission->radiance == line.id) continue;
        const scene::Value* set = params.find(line.id);
        color = set && !set->texture ? *set : scene::default_value(line); // with a texture the number is unused
        break;
    }
    glm::vec3 rgb(color.scalar());
    if (color.type == model::ParamType::color) rgb = {color.v[0], color.v[1], color.v[2]};
    for (int k = 0; k < 3; ++k)
        rgb[k] = rgb[k] > 0 ? std::min(rgb[k], 0.9f) : 0.f;
    return rgb;
}

} // namespace restage::render

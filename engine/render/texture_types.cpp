// SPDX-License-Identifier: Apache-2.0
#include "render/texture_types.hpp"

#include "render/material_types.hpp"

namespace restage::render {

TextureLookup texture_lookup(const plugin::Registry& registry) {
    return [&registry](const std::string& type) -> std::optional<TexturePlugin> {
        const auto entry = registry.find_texture(type);
        if (!entry) return std::nullopt;
        return TexturePlugin{entry->table, entry->plugin->folder, entry->source, entry->blame};
    };
}

std::uint32_t texture_words(const model::Texture& t) {
    std::uint32_t words = 2 + (t.mapped ? map_words : 0) + (t.image ? 1 : 0);
    for (const model::Param& line : t.params)
        words += value_words(line);
    return words;
}

std::string texture_layout(const model::Texture* t) {
    if (!t) return "";
    std::string layout = t->mapped ? "m" : "";
    if (t->image) layout += "i";
    for (const model::Param& line : t->params)
        layout += " " + std::to_string(value_words(line)) + (line.texturable ? "t" : "");
    return layout;
}

bool refresh_texture_types(TextureTypes& types, const TextureLookup& lookup, bool& words_changed) {
    bool shaders = false;
    for (std::size_t i = 0; i < types.size(); ++i) {
        if (types[i].type.empty()) continue;
        TexturePlugin now = lookup ? lookup(types[i].type).value_or(TexturePlugin{}) : TexturePlugin{};
        TexturePlugin& before = types[i].plugin;
        if (now.source == before.source && now.table == before.table) continue;
        words_changed = true; // or the native code differs
        shaders |= now.revision() != before.revision() || !now.table != !before.table;
        if (!before.table || texture_layout(now.table) == texture_layout(before.table)) {
            before = std::move(now);
        } else { // shaders still in use must not read the new words with the old layout
            const std::string type = std::exchange(types[i].type, std::string());
            before = {};
            types.push_back({type, std::move(now)});
        }
    }
    return shaders;
}

} // namespace restage::render

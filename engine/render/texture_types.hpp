// SPDX-License-Identifier: Apache-2.0
// The texture types a scene uses, and the layout of an operation of a texture's program in the words that shaders read:
// render/texture_composer.cpp generates the GLSL that reads what texture_program.cpp packs.
#pragma once

#include "model/texture.hpp"
#include "plugin/registry.hpp"
#include "plugin/texture_source.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace restage::render {

struct TexturePlugin {
    const model::Texture* table = nullptr;
    std::filesystem::path folder; // where its GLSL is
    std::shared_ptr<const plugin::TextureSource> source = nullptr; // owns the table, the GLSL and the native code
    Blame blame = {}; // for crash notes while it is compiled
    std::uint64_t revision() const { return source ? source->revision() : 0; }
    bool native() const { return source && source->eval(); }
};
// Finds the plugin of a texture type; nullopt if there is none: then it shades as its average. [any]
using TextureLookup = std::function<std::optional<TexturePlugin>(const std::string& type)>;
TextureLookup texture_lookup(const plugin::Registry& registry); // `registry` must outlive its users

struct TextureType {
    std::string type; // "": its layout changed when its plugin was reloaded; the number is not reused
    TexturePlugin plugin;
    bool composed() const { return !type.empty() && plugin.table; }
};
// Index + 1 is the kind of its operations; 0 is a literal. Indices are stable for the scene's lifetime.
using TextureTypes = std::vector<TextureType>;
constexpr std::size_t most_texture_types = 255;

// Words of an operation: head, their number, the map (MAPPED: scale, delta, shear), the image (IMAGE), values of the
// lines.
constexpr std::uint32_t map_words = 6;
std::uint32_t texture_words(const model::Texture&);
std::string texture_layout(const model::Texture*); // if equal, shaders composed for one can read the words of the other

// Updates the listed types from the lookup. Returns whether shaders must be recomposed.
bool refresh_texture_types(TextureTypes&, const TextureLookup&, bool& words_changed);

} // namespace restage::render

// SPDX-License-Identifier: Apache-2.0
// The texture types a scene uses, and how an operation of a texture's program lies in the words that shaders read:
// render/texture_composer.cpp writes the GLSL that reads what texture_program.cpp packs.
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
    std::shared_ptr<const plugin::TextureSource> source = nullptr; // holds the table, the GLSL and the native code
    Blame blame = {}; // of a crash while it is compiled
    std::uint64_t revision() const { return source ? source->revision() : 0; }
    bool native() const { return source && source->eval(); }
};
// Finds the plugin of a texture type; nullopt = there is none: it shades as its average. [any]
using TextureLookup = std::function<std::optional<TexturePlugin>(const std::string& type)>;
TextureLookup texture_lookup(const plugin::Registry& registry); // `registry` outlives what uses it

struct TextureType {
    std::string type; // "": one whose words lie otherwise since its plugin was reloaded; its number is not used again
    TexturePlugin plugin;
    bool composed() const { return !type.empty() && plugin.table; }
};
// Index + 1 is the kind of its operations; 0 is a literal. Types never change place while the scene lives.
using TextureTypes = std::vector<TextureType>;
constexpr std::size_t most_texture_types = 255;

// Words of an operation: head, their number, the map (MAPPED: scale, delta, shear), the image (IMAGE), values of the
// lines.
constexpr std::uint32_t map_words = 6;
std::uint32_t texture_words(const model::Texture&);
std::string texture_layout(const model::Texture*); // equal: shaders composed for one read the words of the other

// Takes what the lookup has now, for types that are in the list. Returns whether shaders are to be composed anew.
bool refresh_texture_types(TextureTypes&, const TextureLookup&, bool& words_changed);

} // namespace restage::render

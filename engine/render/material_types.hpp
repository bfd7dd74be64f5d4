// SPDX-License-Identifier: Apache-2.0
// The material types a scene uses, and the layout of a material's values in the parameter words that shaders read.
// render/material_composer.cpp writes the GLSL that reads what pack_material writes: both follow for_each_word.
#pragma once

#include "plugin/registry.hpp"
#include "render/texture_types.hpp"
#include "scene/scene.hpp"

#include <array>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace restage::render {

struct MaterialPlugin {
    const model::Material* table = nullptr;
    std::filesystem::path folder; // where its GLSL is
    // Owns the table and the text of the GLSL; nullptr: the table outlives the renderer, and the folder is read.
    std::shared_ptr<const plugin::MaterialSource> source = nullptr;
    Blame blame = {}; // for crash notes while it is compiled
    bool emits() const { return table && table->emission; }
    std::uint64_t revision() const { return source ? source->revision() : 0; }
};
// Finds the plugin of a material type; nullopt if there is none. Called at each Renderer::sync: a new
// revision is recomposed. [any]
struct MaterialLookup {
    using Find = std::function<std::optional<MaterialPlugin>(const std::string& type)>;
    Find find;
    TextureLookup textures = {}; // likewise for textures
    std::optional<MaterialPlugin> operator()(const std::string& type) const { return find(type); }

    // NOLINTNEXTLINE(google-explicit-constructor): a lambda for materials only suffices
    template <class F>
        requires(!std::is_same_v<std::remove_cvref_t<F>, MaterialLookup> &&
                 std::is_invocable_r_v<std::optional<MaterialPlugin>, F, const std::string&>)
    MaterialLookup(F&& finds) : find(std::forward<F>(finds)) {}
    MaterialLookup(Find finds, TextureLookup finds_textures)
        : find(std::move(finds)), textures(std::move(finds_textures)) {}
};
MaterialLookup material_lookup(const plugin::Registry& registry); // `registry` must outlive its users

struct MaterialType {
    std::string type;
    MaterialPlugin plugin;
    std::vector<bool> textured; // by table line, up to the last one textured by any material of the scene
    bool used = false;          // by a visible instance; types are never removed
    bool bump = false;          // some material of the type has a bump or normal map
    bool curves = false;        // some material of the type has a measured spectrum, in spectral mode
    bool is_textured(std::size_t line) const { return line < textured.size() && textured[line]; }
    bool mix() const { return plugin.table && plugin.table->mix; }
    // Whether its code may return delta lobes.
    bool may_be_specular() const;
    bool null_surface() const { return plugin.table && plugin.table->null_surface; }
};

// Words of one table line: its components, then the texture if it may have one. Lines unseen by shaders have none.
std::uint32_t value_words(const model::Param&);
inline std::uint32_t line_words(const model::Param& p) {
    const auto n = value_words(p);
    return n == 0 ? 0 : n + (p.texturable ? 1 : 0);
}

// A table in device memory; see TableStore.
struct DeviceTable {
    std::uint64_t address = 0;
    std::uint32_t size = 0; // words
};
// The file of a model::ParamType::table line: the set one, else its default; "" = none.
std::string table_path(const model::Param& line, const scene::ParamSet&);

// In spectral mode: the words that a value is stored as (shared/spectral.h), instead of its own.
struct ValueStore {
    std::function<glm::vec3(const model::Param&, const glm::vec3& rgb)> color;
    std::function<std::uint32_t(const model::Param&, float)> number;
};

// The words of one material: values of the table's lines in order, defaults if unset. `tables`: of its
// model::ParamType::table lines, in order; missing ones are empty.
std::vector<std::uint32_t> pack_material(const model::Material&, const scene::ParamSet&,
                                         std::span<const DeviceTable> tables = {}, const ValueStore* = nullptr);

// Appends the words of one line's value, its texture aside; `table`: of a model::ParamType::table line.
void pack_value(const model::Param&, const scene::ParamSet&, std::vector<std::uint32_t>&, DeviceTable table = {},
                const ValueStore* = nullptr);

// The layout of those words, as text: shaders composed for one table can read words packed for another of equal layout.
std::string word_layout(const model::Material*);

// The material's colour while its shader is compiling: its first reflectance colour, or grey.
// Stored in the three words before its own, for compose_stand_in.
glm::vec3 stand_in_color(const model::Material&, const scene::ParamSet&);

} // namespace restage::render

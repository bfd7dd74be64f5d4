// SPDX-License-Identifier: Apache-2.0
#include "render/grey.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace restage::render {
namespace {

bool grey(const glm::vec3& c) { return c.x == c.y && c.y == c.z; }

bool has_spectrum(const scene::Origin& origin) {
    return std::ranges::any_of(origin.values, [](const auto& v) { return v.id.starts_with("spectrum:"); });
}

bool mentions(const plugin::FileTexts& texts, std::span<const std::string_view> words) {
    return std::ranges::any_of(texts, [&](const auto& file) {
        return std::ranges::any_of(words, [&](auto word) { return file.second.find(word) != std::string::npos; });
    });
}

bool grey_params(const scene::ParamSet& params, model::ParamTable table) {
    for (const auto& entry : params.entries())
        if (entry.value.type == model::ParamType::color &&
            !grey({entry.value.v[0], entry.value.v[1], entry.value.v[2]}))
            return false;
    return std::ranges::all_of(table, [&](const model::Param& line) {
        if (line.type == model::ParamType::table) return false;
        return line.type != model::ParamType::color || params.find(line.id) ||
               grey({line.def[0], line.def[1], line.def[2]});
    });
}

constexpr std::array<std::string_view, 3> computes_colors = {"wavelengths", "spectrum_from_rgb", "thin_film"};

bool grey_type(const MaterialPlugin& plugin) {
    if (!plugin.table) return true; // shown as grey
    if (plugin.table->mix || plugin.table->null_surface) return true;
    return plugin.source && !mentions(*plugin.source->glsl(), computes_colors);
}

bool grey_type(const TexturePlugin& plugin) {
    constexpr std::array<std::string_view, 1> converts = {"texture_color"};
    if (!plugin.table) return true; // shows its average
    return plugin.source && !mentions(*plugin.source->glsl(), computes_colors) &&
           (plugin.table->image || !mentions(*plugin.source->glsl(), converts));
}

} // namespace

bool GreyTest::grey_image(const scene::Scene& scene, scene::Id<scene::Image> id) {
    const auto* image = scene.images.find(id);
    if (!image || !image->data || image->data->channels == 1) return true;
    const auto [entry, is_new] = images_.try_emplace(image->data, true);
    if (is_new) {
        const auto& pixels = *image->data;
        for (std::size_t i = 0; entry->second && i + 2 < pixels.values.size(); i += pixels.channels)
            entry->second = grey({pixels.values[i], pixels.values[i + 1], pixels.values[i + 2]});
    }
    return entry->second;
}

bool GreyTest::passes(const scene::Scene& scene, const MaterialLookup& lookup) {
    std::erase_if(images_, [](const auto& entry) { return entry.first.use_count() == 1; });
    bool all = true;
    scene.materials.each([&](scene::Id<scene::Material>, const scene::Material& m) {
        if (!all) return;
        const MaterialPlugin plugin = lookup(m.type).value_or(MaterialPlugin{});
        all = !has_spectrum(m.origin) && grey_type(plugin) &&
              grey_params(m.params, plugin.table ? model::ParamTable(plugin.table->params) : model::ParamTable());
    });
    scene.instances.each([&](scene::Id<scene::Instance>, const scene::Instance& i) {
        all = all && (!i.emission || (grey(i.emission->radiance) && !has_spectrum(i.origin)));
    });
    scene.lights.each([&](scene::Id<scene::Light>, const scene::Light& light) {
        all = all && grey(light.value) && !has_spectrum(light.origin);
    });
    scene.media.each([&](scene::Id<scene::Medium>, const scene::Medium& medium) {
        all = all && grey(medium.sigma_a) && !has_spectrum(medium.origin);
    });
    scene.textures.each([&](scene::Id<scene::Texture>, const scene::Texture& t) {
        if (!all) return;
        const TexturePlugin plugin =
            lookup.textures ? lookup.textures(t.type).value_or(TexturePlugin{}) : TexturePlugin{};
        all = grey_type(plugin) && !has_spectrum(t.origin) &&
              grey_params(t.params, plugin.table ? model::ParamTable(plugin.table->params) : model::ParamTable()) &&
              grey_image(scene, t.image);
    });
    if (const auto& env = scene.environment.value)
        all = all && grey(env->scale) && !has_spectrum(env->origin) && grey_image(scene, env->image);
    return all;
}

} // namespace restage::render

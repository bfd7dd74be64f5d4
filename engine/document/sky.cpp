// SPDX-License-Identifier: Apache-2.0
#include "document/sky.hpp"

#include "io/sky.hpp"
#include "scene/sky.hpp"

namespace restage::document {

using namespace scene;

std::string known_skies(const plugin::Registry& registry) {
    std::string list;
    for (const auto& sky : registry.catalogue()->skies)
        list += (list.empty() ? "" : ", ") + sky.table->type;
    return list.empty() ? "no sky plugin is loaded" : "known: " + list;
}

Result<Edit> plugin_sky(const Scene& scene, const plugin::Registry& registry, const std::string& type,
                        const ParamSet& values, const glm::dvec3& up, const io::Progress& progress) {
    const auto plugin = io::find_sky(registry, type);
    if (!plugin) return fail("there is no sky \"" + type + "\"; " + known_skies(registry));
    ParamSet all;
    if (const auto& now = scene.environment.value; now && now->sky == type) all = now->sky_params;
    for (const auto& [id, value] : values.entries()) {
        RESTAGE_CHECK(io::check_sky_value(*plugin->table, id, value));
        all.set(id, value);
    }
    RESTAGE_TRY(auto pixels, io::make_sky(*plugin, all, progress));
    return made_sky(scene, plugin->table->label, type, std::move(all), std::move(pixels), up);
}

} // namespace restage::document

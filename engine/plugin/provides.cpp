// SPDX-License-Identifier: Apache-2.0
#include "plugin/provides.hpp"

namespace restage::plugin {

std::vector<std::string> provides(const Registry& registry, const Entry& entry) {
    std::vector<std::string> names;
    const auto list = [&](const auto& all, const char* kind, auto&& name) {
        for (const auto& item : all)
            if (item.plugin->folder == entry.folder) names.push_back(kind + name(*item.table));
    };
    const auto catalogue = registry.catalogue();
    list(catalogue->materials, "material ", [](const model::Material& m) { return m.type; });
    list(catalogue->textures, "texture ", [](const model::Texture& t) { return t.type; });
    list(catalogue->importers, "importer ", [](const model::Importer& m) { return m.format; });
    list(catalogue->exporters, "exporter ", [](const model::Exporter& m) { return m.format; });
    list(catalogue->actions, "action ", [](const model::Action& a) { return a.id; });
    list(catalogue->panels, "panel ", [](const model::Panel& p) { return p.id; });
    list(catalogue->skies, "sky ", [](const model::Sky& s) { return s.type; });
    list(catalogue->denoisers, "denoiser ", [](const Denoiser& d) {
        const auto usable = d.available();
        return d.type + (usable ? "" : " (not available: " + usable.error().message + ")");
    });
    return names;
}

} // namespace restage::plugin

// SPDX-License-Identifier: Apache-2.0
#include "plugin/provides.hpp"

namespace restage::plugin {

std::vector<std::string> provides(const Registry& registry, const Entry& entry) {
    std::vector<std::string> names;
    for (const auto& m : registry.materials())
        if (m.plugin->folder == entry.folder) names.push_back(std::string("material ") + m.table->type);
    for (const auto& m : registry.importers())
        if (m.plugin->folder == entry.folder) names.push_back(std::string("importer ") + m.table->format);
    for (const auto& m : registry.exporters())
        if (m.plugin->folder == entry.folder) names.push_back(std::string("exporter ") + m.table->format);
    for (const auto& m : registry.denoisers()) {
        if (m.plugin->folder != entry.folder) continue;
        const char* reason = "";
        const bool usable = m.table->available(&reason);
        names.push_back(std::string("denoiser ") + m.table->type +
                        (usable ? "" : std::string(" (not available: ") + reason + ")"));
    }
    return names;
}

} // namespace restage::plugin

// SPDX-License-Identifier: Apache-2.0
#include "io/material_tables.hpp"

#include "plugin/table_reader.hpp"
#include "scene/edits.hpp"

#include <filesystem>
#include <span>

namespace restage::io {

void report_tables(const scene::Scene& scene, const plugin::Registry& registry, Report& report,
                   const scene::Scene* already) {
    scene.materials.each([&](scene::Id<scene::Material> id, const scene::Material& m) {
        const scene::Material* before = already ? already->materials.find(id) : nullptr;
        const auto plugin = before && *before == m ? std::nullopt : registry.find_material(m.type);
        const auto reader = plugin && plugin->source ? plugin->source->table_reader() : nullptr;
        if (!reader) return;
        for (const model::Param& line : plugin->table->params) {
            const scene::Value* set = m.params.find(line.id);
            if (line.type != model::ParamType::table || !set || set->type != model::ParamType::table ||
                set->text.empty())
                continue;
            const std::string who = "material \"" + m.name + "\"";
            if (const auto table = reader->read(line.id, set->text); !table) {
                report.add(io::Fate::dropped, who, table.error().message + "; shown as grey");
            } else {
                std::string notes;
                for (const std::string& note : (*table)->notes)
                    notes += (notes.empty() ? ": " : "; ") + note;
                report.add(io::Fate::kept, who, "looks up " + set->text + notes);
            }
        }
    });
}

Result<scene::Edit> param_edit(const scene::Scene& scene, const plugin::Registry& registry,
                               scene::Id<scene::Material> id, std::string_view param, scene::Value value) {
    const scene::Material* material = scene.materials.find(id);
    const auto plugin = material ? registry.find_material(material->type) : std::nullopt;
    const bool common = param == "bump" || param == "normalmap";
    if (plugin && !common) {
        const std::string who = "material \"" + material->name + "\": parameter \"" + std::string(param) + "\"";
        const model::Param* line = plugin->table->find(param);
        if (!line) return fail(who + " does not exist in a " + material->type);
        if (value.type == model::ParamType::table && !value.text.empty())
            value.text = std::filesystem::absolute(value.text).lexically_normal().string();
        if (const std::string why = misfit(*line, value); !why.empty()) return fail(who + why);
    }
    return scene::set_param(scene, id, param, std::move(value));
}

} // namespace restage::io

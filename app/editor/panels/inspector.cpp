// SPDX-License-Identifier: Apache-2.0
// Inspector: what is selected. Its place, its material (type and every parameter of the plugin's table), its light.
#include "panels.hpp"

#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <misc/cpp/imgui_stdlib.h>
#include <glm/gtc/matrix_transform.hpp>

namespace restage::editor {

namespace {

void transform_section(Editor& e, InstanceId id) {
    if (!ImGui::CollapsingHeader("Place", ImGuiTreeNodeFlags_DefaultOpen)) return;
    const scene::Instance& instance = e.scene().instances[id];
    glm::vec3 position(glm::dvec3(instance.object_to_world[3]));
    if (ImGui::DragFloat3("Position", &position.x, 0.01f, 0, 0, "%.3f")) {
        glm::dmat4 m = instance.object_to_world;
        m[3] = glm::dvec4(glm::dvec3(position), 1);
        e.edit([id, m](const scene::Scene& s) { return scene::set_transform(s, id, m); }, "inspector.position");
    }
    e.mark("inspector.position");
    const scene::Bounds bounds = scene::world_bounds(e.scene(), id);
    if (!bounds.empty()) {
        const glm::dvec3 size = bounds.size();
        ImGui::TextDisabled("%.3g x %.3g x %.3g units", size.x, size.y, size.z);
    }
}

void material_section(Editor& e, scene::Id<scene::Material> id) {
    const scene::Material* material = e.scene().materials.find(id);
    if (!material) {
        ImGui::TextDisabled("No material");
        return;
    }
    if (!ImGui::CollapsingHeader("Material", ImGuiTreeNodeFlags_DefaultOpen)) return;
    std::size_t users = 0;
    e.scene().instances.each([&](InstanceId, const scene::Instance& i) { users += i.material == id; });
    ImGui::Text("%s", material->name.c_str());
    ImGui::TextDisabled("shared by %zu object%s", users, users == 1 ? "" : "s");
    const auto* plugin = e.registry().find_material(material->type);
    if (ImGui::BeginCombo("Type", plugin ? plugin->table->label : material->type.c_str())) {
        for (const auto& choice : e.registry().materials()) {
            if (ImGui::Selectable(choice.table->label, material->type == choice.table->type))
                e.edit([id, type = std::string(choice.table->type)](const scene::Scene& s) {
                    return scene::set_material_type(s, id, type);
                });
            ImGui::SetItemTooltip("%s", choice.table->tooltip);
            e.mark(std::string("material.type.") + choice.table->type);
        }
        ImGui::EndCombo();
    }
    e.mark("material.type");
    if (!plugin) {
        ImGui::TextColored(colors::warning, "No plugin provides this type; it shades as a placeholder and is kept.");
        return;
    }
    for (std::uint32_t i = 0; i < plugin->table->param_count; ++i) {
        const RestageParam& line = plugin->table->params[i];
        const scene::Value* set = material->params.find(line.id);
        const scene::Value value = set ? *set : scene::default_value(line);
        if (auto changed = param_widget(e, line, value, std::string("material.") + line.id))
            e.edit([id, param = std::string(line.id),
                    v = *changed](const scene::Scene& s) { return scene::set_param(s, id, param, v); },
                   fmt::format("material.{}.{}", id.value, line.id));
    }
}

} // namespace

void draw_inspector(Editor& e) {
    const InstanceId id = e.selection.active();
    if (!id) {
        ImGui::TextDisabled("Click an object to see what it is.");
        return;
    }
    const scene::Instance& instance = e.scene().instances[id];
    ImGui::Text("%s", instance.name.c_str());
    if (e.selection.instances().size() > 1)
        ImGui::TextDisabled("and %zu more; values are of this one", e.selection.instances().size() - 1);
    transform_section(e, id);
    material_section(e, instance.material);
}

} // namespace restage::editor

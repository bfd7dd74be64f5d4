// SPDX-License-Identifier: Apache-2.0
#include "project_texture.hpp"

#include "actions.hpp"
#include "document/projected.hpp"
#include "panel_context.hpp"
#include "plugin/registry.hpp"
#include "scene/box_projection.hpp"
#include "scene/texture_map.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <iterator>
#include <span>

namespace restage::editor {

void project_texture_dialog(SelectContext& e) {
    scene::BoxOptions options{.size = scene::covering_size(e.scene(), e.selection.instances()), .up = e.up()};
    e.show_modal("Project texture", [options, size = float(options.size)](PanelContext& editor) mutable {
        dialog_width(400);
        ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + ImGui::GetItemRectSize().x);
        ImGui::TextUnformatted(
            "Gives each side of the selected objects texture coordinates, seen from the front. They are part of the "
            "mesh, and exported with it; other objects keep theirs.");
        ImGui::PopTextWrapPos();
        ImGui::Spacing();
        form_row("Size", "Of one repetition of a texture, in scene units");
        ImGui::DragFloat("##size", &size, drag_speed(size), 1e-4f, 1e6f, "%.4g", ImGuiSliderFlags_AlwaysClamp);
        editor.mark("project.size");
        form_row("Along",
                 "The object's own axes suit things that are turned; the world's let parts continue each other");
        static constexpr const char* axes[] = {"The object's axes", "The world's axes"};
        int world = options.world_axes ? 1 : 0;
        ImGui::Combo("##axes", &world, axes, 2);
        options.world_axes = world == 1;
        editor.mark("project.axes");
        ImGui::Spacing();
        bool stay = true;
        const bool enter = ImGui::IsKeyPressed(ImGuiKey_Enter, false) && !ImGui::GetIO().WantTextInput;
        if (ImGui::Button("Project") || enter) {
            options.size = double(size);
            editor.edit([ids = editor.selection.instances(), options](const scene::Scene& s) {
                return scene::project_box(s, ids, options);
            });
            stay = false;
        }
        editor.mark("project.do");
        ImGui::SameLine();
        if (ImGui::Button("Cancel") || ImGui::IsKeyPressed(ImGuiKey_Escape, false)) stay = false;
        editor.mark("project.cancel");
        return stay;
    });
}

Result<scene::Edit> project_where_needed(DocumentContext& e, const scene::Scene& scene, Result<scene::Edit> edit,
                                         scene::Id<scene::Material> material) {
    if (!edit) return edit;
    scene::Scene after = scene; // shares its data
    scene::apply(after, *edit);
    return project_where_needed(e, scene, std::move(edit), scene::without_uv(after, material));
}

Result<scene::Edit> project_where_needed(DocumentContext& e, const scene::Scene& scene, Result<scene::Edit> edit,
                                         std::span<const InstanceId> objects) {
    if (!edit) return edit;
    auto [whole, projected] = document::project_where_needed(scene, std::move(*edit), objects, e.registry(), e.up());
    if (!projected.empty())
        e.notices.add(LogLevel::info,
                      fmt::format("{} had no texture coordinates: the texture is projected on each side. Project "
                                  "texture changes its size",
                                  projected.size() == 1 ? scene.instances[projected[0]].name
                                                        : fmt::format("{} objects", projected.size())));
    return std::move(whole);
}

void missing_uv_note(SelectContext& e) {
    const scene::Instance* instance = e.scene().instances.find(e.selection.active());
    const scene::Mesh* mesh = instance ? e.scene().meshes.find(instance->mesh) : nullptr;
    const scene::Material* material = instance ? e.scene().materials.find(instance->material) : nullptr;
    if (!mesh || !mesh->data || !material || scene::has_uv(*mesh)) return;
    const auto textures = scene::textures_of(e.scene(), *material);
    if (std::ranges::none_of(textures, [&](scene::Id<scene::Texture> id) {
            const auto plugin = e.registry().find_texture(e.scene().textures[id].type);
            return plugin && plugin->table->mapped;
        }))
        return;
    warning_note("Its mesh has no texture coordinates: each triangle shows the whole texture.");
    e.mark("material.no_uv");
    action_button(e, "edit.project_texture", "Project texture...");
}

} // namespace restage::editor

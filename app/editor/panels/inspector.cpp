// SPDX-License-Identifier: Apache-2.0
// Inspector: the selection: its name and place, its material (type and every parameter of the plugin's table), its
// light.
#include "inspector.hpp"

#include "panels.hpp"
#include "scene/edits.hpp"
#include "theme.hpp"
#include "view/live_view.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>

namespace restage::editor {

namespace {

// Flags of the selected objects: a click sets all of them to the active object's new value.
void object_section(SelectContext& e, InstanceId id) {
    if (!section_header("Object")) {
        e.mark("inspector.object");
        return;
    }
    e.mark("inspector.object");
    const scene::Instance& instance = e.scene().instances[id];
    const auto ids = e.selection.instances();
    form_row("Hidden", "Invisible, without light or shadow");
    if (bool hidden = instance.hidden; ImGui::Checkbox("##hidden", &hidden))
        e.edit([ids, hidden](const scene::Scene& s) { return scene::set_hidden(s, ids, hidden); });
    e.mark("inspector.hidden");
    form_row("Shadow catcher",
             "Not seen itself, it takes the shadows of other objects and the light they reflect, over the sky or the "
             "backdrop. Its material does not matter: it is as a white, matt surface");
    if (bool catcher = instance.catcher; ImGui::Checkbox("##catcher", &catcher))
        e.edit([ids, catcher](const scene::Scene& s) { return scene::set_catcher(s, ids, catcher); });
    e.mark("inspector.catcher");
    form_row("Locked", "Clicks in the picture ignore it");
    if (bool locked = e.locked.contains(id.value); ImGui::Checkbox("##locked", &locked))
        e.later([&e, ids, locked] {
            for (const InstanceId one : ids)
                if (locked)
                    e.locked.insert(one.value);
                else
                    e.locked.erase(one.value);
        });
    e.mark("inspector.locked");
    form_row("Swap sides",
             "Swaps front and back, for emission and media inside (reversed orientation, flipped normals)");
    if (bool flipped = instance.reverse_orientation; ImGui::Checkbox("##flip", &flipped))
        e.edit([id, flipped](const scene::Scene& s) {
            return scene::modify(s, id, "Swap sides", [&](scene::Instance& i) { i.reverse_orientation = flipped; });
        });
    e.mark("inspector.flip");
    form_row("Opacity", "Opacity: the fraction of the surface that exists (alpha)");
    if (const scene::Texture* cutout = e.scene().textures.find(instance.alpha_texture)) {
        if (ImGui::Button(("Cut out by " + cutout->name + "###cutout").c_str(), {ImGui::CalcItemWidth(), 0}))
            e.edit([id](const scene::Scene& s) {
                return scene::modify(s, id, "Remove cut-out", [&](scene::Instance& i) { i.alpha_texture = {}; });
            });
        tip("A texture cuts holes into it. Click to remove it");
    } else if (float alpha = instance.alpha;
               ImGui::SliderFloat("##alpha", &alpha, 0, 1, "%.3f", ImGuiSliderFlags_AlwaysClamp)) {
        e.edit(
            [id, alpha](const scene::Scene& s) {
                return scene::modify(s, id, "Opacity", [&](scene::Instance& i) { i.alpha = alpha; });
            },
            "inspector.alpha");
    }
    e.mark("inspector.alpha");
    if (const scene::Mesh* mesh = e.scene().meshes.find(instance.mesh); mesh && mesh->data) {
        form_row("Shape", mesh->source_file.empty() ? "Its mesh" : mesh->source_file.c_str());
        ImGui::TextDisabled("%zu triangles", mesh->data->triangles.size());
    }
}

} // namespace

void draw_inspector(SelectContext& e) {
    if (e.selection.light()) {
        light_section(e, e.selection.light());
        return;
    }
    const InstanceId id = e.selection.active();
    const scene::Instance* instance = e.scene().instances.find(id);
    if (!instance) {
        empty_note(e.scene().instances.live()
                       ? "Click an object in the picture or in the outliner to see and change its properties."
                       : "Open a scene first.");
        return;
    }
    std::string name = instance->name;
    ImGui::SetNextItemWidth(-FLT_MIN);
    if (name_field("##name", name)) e.edit([id, name](const scene::Scene& s) { return scene::rename(s, id, name); });
    tip("The object's name");
    e.mark("inspector.name");
    const std::size_t count = e.selection.instances().size();
    if (count > 1) empty_note(fmt::format("and {} more: place, hidden and locked apply to all.", count - 1).c_str());
    place_section(e);
    material_section(e, instance->material);
    emission_section(e, id);
    object_section(e, id);
}

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
#include "copy_paste.hpp"

#include "collide_drag.hpp"
#include "document/clipboard.hpp"
#include "document/session.hpp"
#include "editor.hpp"
#include "files.hpp"
#include "plugin/registry.hpp"
#include "query/aside.hpp"
#include "scene/edits.hpp"

#include <imgui.h>
#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

namespace restage::editor {

namespace {

void copy(SelectContext& e, const document::Selected& selected, const std::string& what) {
    const auto text = document::copy_text(e.session(), selected);
    if (!text) {
        e.notices.add(LogLevel::error, text.error().message);
        return;
    }
    ImGui::SetClipboardText(text->c_str());
    e.copied = {.text = *text, .instances = {}};
    for (const InstanceId id : selected.instances)
        e.copied.instances.emplace_back(id, e.scene().instances[id]);
    e.notices.add(LogLevel::info, "Copied " + what);
}

// Whether the pasted things are currently in the document.
void add(Editor& e, const document::Copy& copied) {
    document::Session& session = e.session_for_changes();
    if (copied.material) {
        if (e.selection.instances().empty()) {
            e.notices.add(LogLevel::info, "Select the objects to give the material to");
            return;
        }
        if (const auto done = session.edit(document::paste_material(session.scene(), copied, e.selection.instances()));
            !done)
            e.notices.add(LogLevel::error, done.error().message);
        return;
    }
    const glm::dvec3 offset = aside(e, scene::world_bounds(copied.scene));
    std::vector<InstanceId> all;
    copied.scene.instances.each([&](InstanceId id, const scene::Instance&) { all.push_back(id); });
    const glm::dvec3 room = room_for(e, copied.scene, all, glm::translate(glm::dmat4(1), offset));
    document::Pasted pasted = document::paste(session.scene(), copied.scene, offset + room);
    session.edit(std::move(pasted.edit));
    if (pasted.instances.empty())
        e.selection.set_light(pasted.light);
    else
        e.selection.set(pasted.instances);
}

} // namespace

void copy_selected(SelectContext& e) {
    const auto& ids = e.selection.instances();
    if (const scene::Light* light = e.scene().lights.find(e.selection.light()))
        copy(e, {.light = e.selection.light()}, light->name);
    else if (!ids.empty())
        copy(e, {.instances = ids},
             ids.size() == 1 ? e.scene().instances[ids[0]].name : std::to_string(ids.size()) + " objects");
}

void copy_material(SelectContext& e, scene::Id<scene::Material> id) {
    if (const scene::Material* material = e.scene().materials.find(id))
        copy(e, {.material = id}, "material " + material->name);
}

bool newer_in_clipboard(const SelectContext& e) {
    const char* held = ImGui::GetClipboardText();
    return held && document::is_copy(held) && e.copied.text != held;
}

void paste(Editor& e) {
    const char* held = ImGui::GetClipboardText();
    std::string text = held ? held : "";
    if (!document::is_copy(text)) {
        e.notices.add(LogLevel::info, "The clipboard contains nothing from Restage: copy objects or a material first");
        return;
    }
    const auto& ours = e.copied.instances;
    if (text == e.copied.text && !ours.empty() && std::ranges::all_of(ours, [&](const auto& one) {
            const scene::Instance* now = e.scene().instances.find(one.first);
            return now && *now == one.second;
        })) { // they share geometry and materials
        std::vector<InstanceId> ids;
        scene::Bounds bounds;
        for (const auto& [id, instance] : ours) {
            ids.push_back(id);
            bounds.add(scene::world_bounds(e.scene(), id));
        }
        const glm::dvec3 offset = aside(e, bounds);
        const glm::dvec3 room = room_for(e, e.scene(), ids, glm::translate(glm::dmat4(1), offset));
        auto made = e.session_for_changes().duplicate(ids, glm::translate(glm::dmat4(1), offset + room));
        if (!made) return e.notices.add(LogLevel::error, made.error().message);
        e.selection.things.copied(ids, *made);
        return e.selection.set(*made);
    }
    // Pasted things that refer to files read them.
    e.files().jobs.start(
        {.title = "Pasting"},
        [text = std::move(text), &registry = e.registry(), &e](BackgroundJob&) -> std::function<void(PanelContext&)> {
            auto copied = document::read_copy(text, registry);
            if (!copied)
                return [message = copied.error().message](PanelContext& editor) {
                    editor.notices.add(LogLevel::error, message);
                };
            return [copied = std::make_shared<const document::Copy>(std::move(*copied)), &e](PanelContext&) {
                e.later([&e, copied] { add(e, *copied); });
            };
        });
}

glm::dvec3 aside(const SelectContext& e, const scene::Bounds& bounds) {
    scene::Bounds box = bounds;
    double least = bounds.radius() * 0.1;
    if (!(least > 0)) { // a lamp is a point
        const scene::Bounds all = scene::world_bounds(e.scene());
        if (box.empty()) box.add(all.empty() ? glm::dvec3(0) : all.center());
        least = all.radius() > 0 ? all.radius() * 0.1 : 1;
    }
    return query::visible_offset(e.camera(), e.film_aspect(), e.up(), box, least);
}

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
#include "actions.hpp"

#include "editor.hpp"
#include "final_render.hpp"
#include "io/material_emission.hpp"
#include "panels/outliner.hpp"
#include "saving.hpp"
#include "session/navigation.hpp"
#include "session/support.hpp"
#include "session/touching.hpp"

#include <imgui_internal.h>
#include <algorithm>
#include <array>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

namespace restage::editor {

namespace {

bool has_selection(const Editor& e) { return !e.selection.empty(); }
bool has_objects(const Editor& e) { return !e.selection.instances().empty(); }
bool has_scene(const Editor& e) { return e.scene().instances.live() > 0; }

void remove_selected(Editor& e) {
    const auto ids = e.selection.instances();
    const auto light = e.selection.light();
    e.edit([ids, light](const scene::Scene& s) {
        return light ? scene::remove(s, light) : scene::remove_instances(s, ids);
    });
}

void duplicate_selected(Editor& e) {
    // A little to the side, so that the copy is seen: a tenth of its size along the world axis that is most across the
    // view.
    const scene::Bounds bounds = e.selection.bounds(e.scene());
    const glm::dvec3 right = glm::normalize(glm::dvec3(e.camera().camera_to_world[0]));
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (std::abs(right[i]) > std::abs(right[axis])) axis = i;
    glm::dvec3 step(0);
    step[axis] =
        (right[axis] < 0 ? -1 : 1) * (bounds.empty() ? 0 : std::max(bounds.size()[axis] * 1.05, bounds.radius() * 0.1));
    auto made = e.session_for_changes().duplicate(e.selection.instances(), glm::translate(glm::dmat4(1), step));
    if (made)
        e.selection.set(*made);
    else
        e.notices.add(LogLevel::error, made.error().message);
}

void frame_bounds(Editor& e, const scene::Bounds& bounds) {
    if (bounds.empty()) return;
    scene::Camera camera = e.camera();
    session::frame(camera, bounds, e.film_aspect());
    e.edit([camera](const scene::Scene& s) { return scene::set_camera(s, s.active_camera.value, camera, "Frame"); });
}

void go_to(Editor& e, const scene::Camera& camera, const std::string& label) {
    scene::Camera there = camera;
    there.name = e.camera().name;
    there.origin = e.camera().origin;
    e.edit([there, label](const scene::Scene& s) { return scene::set_camera(s, s.active_camera.value, there, label); });
}

// A bookmark is a camera of the scene that is not the active one: saved, undone and exported like anything else.
void bookmark(Editor& e) {
    e.edit([camera = e.camera()](const scene::Scene& s) -> Result<scene::Edit> {
        scene::Camera copy = camera;
        copy.name = "View " + std::to_string(s.cameras.live());
        copy.origin = {};
        return scene::insert(s, copy, "Bookmark " + copy.name);
    });
}

// The next bookmark after the one the view is at.
void next_bookmark(Editor& e) {
    std::vector<scene::Camera> views;
    std::size_t at = 0;
    e.scene().cameras.each([&](scene::Id<scene::Camera> id, const scene::Camera& camera) {
        if (id == e.camera_id()) return;
        if (camera.camera_to_world == e.camera().camera_to_world) at = views.size() + 1;
        views.push_back(camera);
    });
    if (!views.empty()) go_to(e, views[at % views.size()], "Go to " + views[at % views.size()].name);
}

void drop_to_floor(Editor& e) {
    const auto ids = e.selection.instances();
    const auto distance = session::fall_distance(e.scene(), ids, e.up());
    if (!distance) {
        e.notices.add(LogLevel::info, "There is nothing below to stand on");
        return;
    }
    const glm::dmat4 move = glm::translate(glm::dmat4(1), -e.up() * *distance);
    e.edit([ids, move](const scene::Scene& s) {
        auto edit = scene::move_instances(s, ids, move);
        if (edit) edit->label = "Drop to floor";
        return edit;
    });
}

void select_touching(Editor& e) {
    std::vector<InstanceId> more = session::touching(e.scene(), e.selection.instances(),
                                                     [&](InstanceId id) { return e.locked.contains(id.value); });
    e.notices.add(LogLevel::info, more.empty() ? "Nothing of its size touches it"
                                               : std::to_string(more.size()) + " more objects touch it");
    if (more.empty()) return;
    more.push_back(e.selection.active()); // stays the active one
    e.selection.set(more, Selection::Mode::add);
}

GroupId group_of_selection(const Editor& e) {
    const scene::Instance* active = e.scene().instances.find(e.selection.active());
    return active ? e.selection.click_group(e.scene(), e.selection.active()) : GroupId{};
}

void set_hidden(Editor& e, bool hidden) {
    const auto ids = e.selection.instances();
    e.edit([ids, hidden](const scene::Scene& s) { return scene::set_hidden(s, ids, hidden); });
}

void isolate(Editor& e) {
    std::vector<InstanceId> others;
    const io::MaterialEmissions emissions(e.registry(), e.scene());
    e.scene().instances.each([&](InstanceId id, const scene::Instance& instance) {
        if (!e.selection.contains(id) && !instance.hidden && !emissions.shines(instance)) others.push_back(id);
    });
    e.edit([others](const scene::Scene& s) {
        auto edit = scene::set_hidden(s, others, true);
        if (edit) edit->label = "Isolate";
        return edit;
    });
}

void show_all(Editor& e) {
    std::vector<InstanceId> hidden;
    e.scene().instances.each([&](InstanceId id, const scene::Instance& instance) {
        if (instance.hidden) hidden.push_back(id);
    });
    e.edit([hidden](const scene::Scene& s) {
        auto edit = scene::set_hidden(s, hidden, false);
        if (edit) edit->label = "Show all";
        return edit;
    });
}

void select_all(Editor& e) {
    std::vector<InstanceId> all;
    e.scene().instances.each([&](InstanceId id, const scene::Instance& instance) {
        if (!instance.hidden && !e.locked.contains(id.value)) all.push_back(id);
    });
    e.selection.set(all);
}

template <GizmoMode mode>
void set_gizmo(Editor& e) {
    e.view.gizmo = mode;
}
template <GizmoMode mode>
bool is_gizmo(const Editor& e) {
    return e.view.gizmo == mode;
}

// The order is the menus'. Keys as in Unity and Maya; the second ones as in Blender.
constexpr auto actions = std::to_array<Action>({
    {"file.new", "New", ImGuiMod_Ctrl | ImGuiKey_N, 0, "An empty studio: a floor, a neutral sky, a camera", nullptr,
     new_scene},
    {"file.open", "Open...", ImGuiMod_Ctrl | ImGuiKey_O, 0, "A scene or a project", nullptr, open_dialog},
    {"file.insert", "Insert file...", ImGuiMod_Ctrl | ImGuiMod_Shift | ImGuiKey_I, 0,
     "What a file shows, as new objects", has_scene, insert_dialog},
    {"file.save", "Save", ImGuiMod_Ctrl | ImGuiKey_S, 0, "The project: the scene it began with and your changes",
     has_scene, [](Editor& e) { save(e); }},
    {"file.save_as", "Save as...", ImGuiMod_Ctrl | ImGuiMod_Shift | ImGuiKey_S, 0, "The project under another name",
     has_scene, [](Editor& e) { save_as(e); }},
    {"file.revert", "Revert...", 0, 0, "Back to what was opened or saved last",
     [](const Editor& e) { return !e.session().path().empty() && e.session().modified(); }, revert},
    {"file.export", "Export...", ImGuiMod_Ctrl | ImGuiKey_E, 0, "A scene file for other programs", has_scene,
     export_dialog},
    {"file.save_image", "Save picture...", ImGuiMod_Ctrl | ImGuiMod_Shift | ImGuiKey_E, 0,
     "The live picture as it is now", has_scene, save_image_dialog},
    {"file.final", "Final picture...", ImGuiMod_Ctrl | ImGuiKey_R, 0,
     "Render in full size and quality in the background, denoise, write", has_scene, final_render_dialog},
    {"file.quit", "Quit", ImGuiMod_Ctrl | ImGuiKey_Q, 0, "Asks when something is not saved", nullptr,
     [](Editor& e) { e.request_quit(); }},
    {"edit.undo", "Undo", ImGuiMod_Ctrl | ImGuiKey_Z, 0, "Take the last change back",
     [](const Editor& e) { return e.session().history().position() > 0; }, [](Editor& e) { e.undo(); }},
    {"edit.redo", "Redo", ImGuiMod_Ctrl | ImGuiKey_Y, ImGuiMod_Ctrl | ImGuiMod_Shift | ImGuiKey_Z,
     "Do again what was taken back",
     [](const Editor& e) { return e.session().history().position() < e.session().history().size(); },
     [](Editor& e) { e.redo(); }},
    {"edit.duplicate", "Duplicate", ImGuiMod_Ctrl | ImGuiKey_D, ImGuiMod_Shift | ImGuiKey_D,
     "Copy the selected objects; copies share geometry and material", has_objects, duplicate_selected},
    {"edit.delete", "Delete", ImGuiKey_Delete, ImGuiKey_X, "Remove what is selected", has_selection, remove_selected},
    {"edit.group", "Group", ImGuiMod_Ctrl | ImGuiKey_G, 0, "From now on a click picks all of what is selected now",
     has_objects, group_selected},
    {"edit.ungroup", "Ungroup", ImGuiMod_Ctrl | ImGuiMod_Shift | ImGuiKey_G, 0,
     "A click picks single objects of the selected group again",
     [](const Editor& e) { return bool(group_of_selection(e)); }, [](Editor& e) { ungroup(e, group_of_selection(e)); }},
    {"edit.drop", "Drop to floor", ImGuiKey_End, 0, "Let the selected objects fall onto what is below", has_objects,
     drop_to_floor},
    {"select.all", "All", ImGuiMod_Ctrl | ImGuiKey_A, ImGuiKey_A, "Select every visible object that is not locked",
     has_scene, select_all},
    {"select.none", "None", ImGuiKey_Escape, 0, "Select nothing; leave the entered group; before that, close the help",
     [](const Editor& e) { return e.panel_open("Help") || has_selection(e) || e.selection.entered(); },
     [](Editor& e) {
         if (e.panel_open("Help")) return e.open_panel("Help", false);
         e.selection.clear();
         e.selection.enter({});
     }},
    {"select.touching", "What touches it", ImGuiKey_C, 0,
     "Add the parts that the selected objects touch, and what these touch: a whole chair, or a table and what is on it. "
     "Much larger things, like the floor, are left out",
     has_objects, select_touching},
    {"select.hide", "Hide", ImGuiKey_H, 0, "Hide the selected objects", has_objects,
     [](Editor& e) { set_hidden(e, true); }},
    {"select.isolate", "Isolate", ImGuiMod_Shift | ImGuiKey_H, 0, "Hide all others (lamps stay)", has_objects, isolate},
    {"select.show_all", "Show all", ImGuiMod_Alt | ImGuiKey_H, 0, "Show what was hidden", has_scene, show_all},
    {"select.lock", "Lock", ImGuiMod_Ctrl | ImGuiKey_L, 0, "Selected objects cannot be picked by clicks any more",
     has_objects,
     [](Editor& e) {
         for (const InstanceId id : e.selection.instances())
             e.locked.insert(id.value);
         e.selection.clear();
     }},
    {"select.unlock_all", "Unlock all", 0, 0, "Every object can be picked again",
     [](const Editor& e) { return !e.locked.empty(); }, [](Editor& e) { e.locked.clear(); }},
    {"view.frame_selected", "Frame selected", ImGuiKey_F, ImGuiKey_KeypadDecimal,
     "Move the camera so that the selection fills the picture", has_selection,
     [](Editor& e) { frame_bounds(e, e.selection.bounds(e.scene())); }},
    {"view.frame_all", "Frame all", ImGuiKey_Home, 0, "Move the camera so that everything is seen", has_scene,
     [](Editor& e) { frame_bounds(e, scene::world_bounds(e.scene())); }},
    {"view.file_camera", "Camera of the file", ImGuiMod_Shift | ImGuiKey_Home, 0,
     "Back to where the camera was when opened", [](const Editor& e) { return e.opened_camera() != nullptr; },
     [](Editor& e) { go_to(e, *e.opened_camera(), "Camera of the file"); }},
    {"view.bookmark", "Bookmark view", ImGuiKey_B, 0, "Keep this view; it is saved with the scene", has_scene,
     bookmark},
    {"view.next_bookmark", "Next bookmark", ImGuiMod_Shift | ImGuiKey_B, 0, "Go to the next view that was kept",
     [](const Editor& e) { return e.scene().cameras.live() > 1; }, next_bookmark},
    {"view.gizmo_select", "Select tool", ImGuiKey_Q, 0, "No handles", nullptr, set_gizmo<GizmoMode::select>,
     is_gizmo<GizmoMode::select>},
    {"view.gizmo_move", "Move tool", ImGuiKey_W, ImGuiKey_G, "Handles that move; Ctrl snaps, Alt copies", nullptr,
     set_gizmo<GizmoMode::move>, is_gizmo<GizmoMode::move>},
    {"view.gizmo_rotate", "Rotate tool", ImGuiKey_E, ImGuiKey_R, "Handles that turn; Ctrl snaps", nullptr,
     set_gizmo<GizmoMode::rotate>, is_gizmo<GizmoMode::rotate>},
    {"view.gizmo_scale", "Scale tool", ImGuiKey_R, ImGuiKey_S, "Handles that stretch; Ctrl snaps", nullptr,
     set_gizmo<GizmoMode::scale>, is_gizmo<GizmoMode::scale>},
    {"view.local", "Local axes", ImGuiKey_L, 0, "Handles along the object's own axes instead of the world's", nullptr,
     [](Editor& e) { e.view.local_axes = !e.view.local_axes; }, [](const Editor& e) { return e.view.local_axes; }},
    {"view.denoise", "Denoise", ImGuiKey_N, 0, "Show the denoised picture", nullptr,
     [](Editor& e) { e.view.denoise = !e.view.denoise; }, [](const Editor& e) { return e.view.denoise; }},
    {"view.overlays", "Overlays", ImGuiKey_V, 0, "Outlines, handles, numbers and messages over the picture", nullptr,
     [](Editor& e) { e.view.show_overlays = !e.view.show_overlays; },
     [](const Editor& e) { return e.view.show_overlays; }},
    {"view.inspect", "Pixel values", ImGuiKey_I, 0, "Radiance, error, object and distance of the pixel under the mouse",
     nullptr, [](Editor& e) { e.view.inspect_pixels = !e.view.inspect_pixels; },
     [](const Editor& e) { return e.view.inspect_pixels; }},
    {"view.panels", "Panels", ImGuiKey_Tab, 0, "Show or hide all panels", nullptr,
     [](Editor& e) { e.view.show_panels = !e.view.show_panels; }, [](const Editor& e) { return e.view.show_panels; }},
    {"help.shortcuts", "Shortcuts and help", ImGuiMod_Shift | ImGuiKey_Slash, 0,
     "Every shortcut, and how to get around", nullptr, [](Editor& e) { e.open_panel("Help", !e.panel_open("Help")); },
     [](const Editor& e) { return e.panel_open("Help"); }},
});

} // namespace

std::span<const Action> all_actions() { return actions; }

const Action* find_action(std::string_view id) {
    const auto found = std::find_if(actions.begin(), actions.end(), [&](const Action& a) { return a.id == id; });
    return found == actions.end() ? nullptr : &*found;
}

ImGuiKeyChord key_of(const Action& action, KeyPreset preset) {
    return preset == KeyPreset::blender && action.blender_key ? action.blender_key : action.key;
}

std::string_view key_text(ImGuiKeyChord key) { return key ? ImGui::GetKeyChordName(key) : ""; }

void run_shortcuts(Editor& editor, const std::vector<ImGuiKeyChord>* keys) {
    const ImGuiIO& io = ImGui::GetIO();
    // While text is typed, a dialog is open, or the camera flies on WASD, keys mean something else.
    const bool popup = ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
    // Dear ImGui closes menus and lists with Esc only where it also navigates by keys. Dialogs do it themselves.
    if (popup && keys && std::find(keys->begin(), keys->end(), ImGuiKey_Escape) != keys->end() &&
        !ImGui::GetTopMostPopupModal())
        ImGui::ClosePopupToLevel(0, true);
    if (io.WantTextInput || popup || ImGui::IsMouseDown(ImGuiMouseButton_Right)) return;
    for (const Action& action : actions) {
        const ImGuiKeyChord key = key_of(action, editor.view.keys);
        if (key == ImGuiKey_Escape && editor.pick_tool) continue; // gives up that, not the selection
        if (key && (keys ? std::find(keys->begin(), keys->end(), key) != keys->end() : ImGui::IsKeyChordPressed(key)))
            editor.run(action.id);
    }
}

void menu_item(Editor& editor, std::string_view id) {
    const Action* action = find_action(id);
    if (!action) return;
    const bool enabled = !action->enabled || action->enabled(editor);
    const std::string key(key_text(key_of(*action, editor.view.keys)));
    if (ImGui::MenuItem(action->label, key.c_str(), action->checked && action->checked(editor), enabled))
        editor.run(id);
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_ForTooltip | ImGuiHoveredFlags_AllowWhenDisabled))
        ImGui::SetTooltip("%s", action->tooltip);
    editor.mark(action->id);
}

bool action_button(Editor& editor, std::string_view id, const char* label) {
    const Action* action = find_action(id);
    if (!action) return false;
    const bool on = action->checked && action->checked(editor);
    const bool enabled = !action->enabled || action->enabled(editor);
    ImGui::BeginDisabled(!enabled);
    if (on) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_HeaderActive));
    const bool pressed = ImGui::Button(label ? label : action->label);
    if (on) ImGui::PopStyleColor();
    ImGui::EndDisabled();
    editor.mark(action->id);
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_ForTooltip | ImGuiHoveredFlags_AllowWhenDisabled)) {
        const std::string key(key_text(key_of(*action, editor.view.keys)));
        ImGui::SetTooltip("%s%s%s%s\n%s", action->label, key.empty() ? "" : " (", key.c_str(), key.empty() ? "" : ")",
                          action->tooltip);
    }
    if (pressed) editor.run(id);
    return pressed;
}

} // namespace restage::editor

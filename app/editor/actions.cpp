// SPDX-License-Identifier: Apache-2.0
#include "actions.hpp"

#include "arrange.hpp"
#include "copy_paste.hpp"
#include "document/session.hpp"
#include "duplicating.hpp"
#include "editor.hpp"
#include "highlight.hpp"
#include "importing.hpp"
#include "io/material_emission.hpp"
#include "kept_pictures.hpp"
#include "linking.hpp"
#include "looks.hpp"
#include "packing.hpp"
#include "panels/light_buttons.hpp"
#include "panels/outliner.hpp"
#include "panels/state.hpp"
#include "place_texture.hpp"
#include "plugin/registry.hpp"
#include "project_texture.hpp"
#include "query/navigation.hpp"
#include "query/support.hpp"
#include "query/touching.hpp"
#include "saving.hpp"
#include "scene/edits.hpp"
#include "scene/links.hpp"
#include "shadow_floor.hpp"
#include "view/live_view.hpp"
#include "viewport.hpp"

#include <fmt/format.h>
#include <imgui_internal.h>
#include <algorithm>
#include <array>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

namespace restage::editor {

namespace {

bool has_selection(const PanelContext& e) { return !e.selection.empty(); }
bool has_objects(const PanelContext& e) { return !e.selection.instances().empty(); }
bool has_scene(const PanelContext& e) { return e.scene().instances.live() > 0; }

void remove_selected(Editor& e) {
    const auto ids = e.selection.instances();
    const auto light = e.selection.light();
    e.edit([ids, light](const scene::Scene& s) {
        return light ? scene::remove(s, light) : scene::remove_instances(s, ids);
    });
}

void frame_bounds(Editor& e, const scene::Bounds& bounds) {
    if (bounds.empty()) return;
    scene::Camera camera = e.camera();
    query::frame(camera, bounds, e.film_aspect());
    e.look_from(camera.camera_to_world, {}, "Frame");
}

// A bookmark is a camera of the scene that is not the active one: saved, undone and exported like anything else.
void bookmark(Editor& e) {
    e.edit([camera = e.camera()](const scene::Scene& s) -> Result<scene::Edit> {
        scene::Camera copy = camera;
        std::set<std::string> taken;
        s.cameras.each([&](auto, const scene::Camera& c) { taken.insert(c.name); });
        copy.name = taken.contains("View 1") ? scene::next_name("View 1", taken) : "View 1";
        copy.origin = {};
        return scene::insert(s, copy, "Bookmark " + copy.name);
    });
}

// The bookmark after the current one. Only its position and orientation are used: lens and field of view are the
// camera's.
void next_bookmark(Editor& e) {
    std::vector<const scene::Camera*> places;
    std::size_t at = 0;
    e.scene().cameras.each([&](scene::Id<scene::Camera> id, const scene::Camera& camera) {
        if (id == e.camera_id()) return;
        if (camera.camera_to_world == e.camera().camera_to_world) at = places.size() + 1;
        places.push_back(&camera);
    });
    if (places.empty()) return;
    const scene::Camera& to = *places[at % places.size()];
    e.look_from(to.camera_to_world, {}, "Go to bookmark");
}

void set_camera_to_view(Editor& e) {
    e.edit([place = e.camera().camera_to_world](const scene::Scene& s) {
        const scene::Camera* camera = s.cameras.find(s.active_camera.value);
        if (!camera) return Result<scene::Edit>(fail("the scene has no camera"));
        scene::Camera moved = *camera;
        moved.camera_to_world = place;
        return scene::set_camera(s, s.active_camera.value, moved, "Set camera to view");
    });
}

bool view_is_apart(const PanelContext& e) { return e.views.now().has_value(); }

void drop_to_floor(Editor& e) {
    const auto ids = e.selection.instances();
    const auto distance = query::fall_distance(e.scene(), ids, e.up());
    if (!distance) {
        e.notices.add(LogLevel::info, "There is nothing below the object");
        return;
    }
    const glm::dmat4 move = glm::translate(glm::dmat4(1), -e.up() * *distance);
    e.edit([ids, move](const scene::Scene& s) {
        auto edit = scene::move_instances(s, ids, move);
        if (edit) edit->label = "Drop to floor";
        return edit;
    });
}

void show_arrange(Editor& e) {
    e.view.show_panels = true;
    e.open_panel("Arrange");
    ImGui::SetWindowFocus("Arrange");
}

void ask_for_array(Editor& e) {
    show_arrange(e);
    e.panel_state->arrange.asked = true;
}

template <int axis>
void mirror(Editor& e) {
    mirror_in_place(e, axis);
}

void select_touching(Editor& e) {
    std::vector<InstanceId> more =
        query::touching(e.scene(), e.selection.instances(), [&](InstanceId id) { return e.locked.contains(id.value); });
    e.notices.add(LogLevel::info, more.empty() ? "Nothing of similar size touches it"
                                               : std::to_string(more.size()) + " more objects touch it");
    if (more.empty()) return;
    more.push_back(e.selection.active()); // remains the active object
    e.selection.set(more, Selection::Mode::add);
}

GroupId group_of_selection(const PanelContext& e) {
    const scene::Instance* active = e.scene().instances.find(e.selection.active());
    return active ? e.selection.click_group(e.scene(), e.selection.active()) : GroupId{};
}

void set_hidden(Editor& e, bool hidden) {
    if (const auto light = e.selection.light())
        return e.edit([light, hidden](const scene::Scene& s) { return scene::set_hidden(s, light, hidden); });
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
    std::vector<scene::Id<scene::Light>> lights;
    e.scene().lights.each([&](scene::Id<scene::Light> id, const scene::Light& light) {
        if (light.hidden) lights.push_back(id);
    });
    e.edit([hidden, lights](const scene::Scene& s) {
        auto edit = scene::set_hidden(s, hidden, false);
        for (const auto light : lights) {
            const auto one = scene::set_hidden(s, light, false);
            if (edit && one) edit->changes.insert(edit->changes.end(), one->changes.begin(), one->changes.end());
        }
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

bool shows_exposure(const PanelContext& e) { return e.view.display.layer == view::exposure_layer; }
void toggle_exposure(Editor& e) {
    e.view.display.layer = shows_exposure(e) ? view::picture_layer : view::exposure_layer;
}

// Actions that need only what panels can access.
template <auto what>
void run(Editor& e) {
    what(e);
}
template <auto what>
bool has(const PanelContext& e) {
    return what(e);
}
template <GizmoMode mode>
void set_gizmo(Editor& e) {
    e.view.gizmo = mode;
}
template <GizmoMode mode>
bool is_gizmo(const PanelContext& e) {
    return e.view.gizmo == mode;
}

// Shows that layer, or the picture again.
template <const std::string_view& layer>
void show_layer(Editor& e) {
    e.view.display.layer = e.view.display.layer == layer ? view::picture_layer : layer;
}
template <const std::string_view& layer>
bool is_layer(const PanelContext& e) {
    return e.view.display.layer == layer;
}
constexpr std::string_view objects_layer = "object_id", materials_layer = "material_id"; // of render/film_layers.hpp

// In menu order. Keys as in Unity and Maya; the second ones as in Blender.
constexpr auto actions = std::to_array<Action>({
    {"file.new", "New", ImGuiMod_Ctrl | ImGuiKey_N, 0, "An empty studio: a floor, a neutral sky, a camera", nullptr,
     new_scene},
    {"file.open", "Open...", ImGuiMod_Ctrl | ImGuiKey_O, 0, "A scene or a project", nullptr, open_dialog},
    {"file.insert", "Insert file...", ImGuiMod_Ctrl | ImGuiMod_Shift | ImGuiKey_I, 0,
     "Adds a file's contents as new objects", has_scene, insert_dialog},
    {"file.link", "Link file...", 0, 0, "Shows a file's objects in place; they stay the file's, and follow it",
     has_scene, link_dialog},
    {"file.reload_links", "Reload links", 0, 0, "Reads all linked files again; a changed one is read by itself",
     [](const PanelContext& e) { return !scene::all_links(e.scene()).empty(); }, reload_links},
    {"file.import_again", "Import again...", 0, 0, "Reads the scene's file again with other options",
     [](const PanelContext& e) { return why_not_import_again(e).empty(); }, import_again},
    {"file.read_again", "Read again", 0, 0, "Reads the scene's file again, with the options last chosen for its format",
     [](const PanelContext& e) { return why_not_import_again(e).empty(); }, read_again},
    {"file.save", "Save", ImGuiMod_Ctrl | ImGuiKey_S, 0, "The project: the original scene and your changes", has_scene,
     [](Editor& e) { save(e); }},
    {"file.save_as", "Save as...", ImGuiMod_Ctrl | ImGuiMod_Shift | ImGuiKey_S, 0, "The project under another name",
     has_scene, [](Editor& e) { save_as(e); }},
    {"file.pack", "Pack project...", 0, 0, "A copy with all files that it needs, to take to another machine", has_scene,
     run<pack_dialog>},
    {"file.revert", "Revert...", 0, 0, "Back to the last opened or saved state",
     [](const PanelContext& e) { return !e.session().path().empty() && e.session().modified(); }, revert},
    {"file.export", "Export...", ImGuiMod_Ctrl | ImGuiKey_E, 0, "A scene file for other programs", has_scene,
     run<export_dialog>},
    {"file.save_image", "Save picture...", ImGuiMod_Ctrl | ImGuiMod_Shift | ImGuiKey_E, 0, "The current live picture",
     has_scene, run<save_image_dialog>},
    {"file.final", "Final picture...", ImGuiMod_Ctrl | ImGuiKey_R, 0,
     "Render at full size and quality in the background, denoise, and write", has_scene, run<final_render_dialog>},
    {"file.quit", "Quit", ImGuiMod_Ctrl | ImGuiKey_Q, 0, "Asks first if there are unsaved changes", nullptr,
     [](Editor& e) { e.request_quit(); }},
    {"edit.undo", "Undo", ImGuiMod_Ctrl | ImGuiKey_Z, 0, "Undo the last change",
     [](const PanelContext& e) { return e.session().history().position() > 0; }, [](Editor& e) { e.undo(); }},
    {"edit.redo", "Redo", ImGuiMod_Ctrl | ImGuiKey_Y, ImGuiMod_Ctrl | ImGuiMod_Shift | ImGuiKey_Z,
     "Redo the last undone change",
     [](const PanelContext& e) { return e.session().history().position() < e.session().history().size(); },
     [](Editor& e) { e.redo(); }},
    {"edit.duplicate", "Duplicate", ImGuiMod_Ctrl | ImGuiKey_D, ImGuiMod_Shift | ImGuiKey_D,
     "Copies the selection next to it, where the picture shows it; again, also after moving the copy: the next one at "
     "the "
     "same offset. Copies of objects share geometry and material",
     has_selection, duplicate_selected},
    {"edit.copy", "Copy", ImGuiMod_Ctrl | ImGuiKey_C, 0,
     "Copies objects or a light to the clipboard, for this or another Restage window", has_selection,
     run<copy_selected>},
    {"edit.paste", "Paste", ImGuiMod_Ctrl | ImGuiKey_V, 0,
     "Inserts copied things, also from another window; a material is assigned to the selection", has_scene, paste},
    {"edit.delete", "Delete", ImGuiKey_Delete, ImGuiKey_X, "Remove the selection", has_selection, remove_selected},
    {"edit.group", "Group", ImGuiMod_Ctrl | ImGuiKey_G, 0, "A click then selects all of the group", has_objects,
     run<group_selected>},
    {"edit.ungroup", "Ungroup", ImGuiMod_Ctrl | ImGuiMod_Shift | ImGuiKey_G, 0,
     "A click then selects single objects of the group again",
     [](const PanelContext& e) { return bool(group_of_selection(e)); },
     [](Editor& e) { ungroup(e, group_of_selection(e)); }},
    {"edit.make_editable", "Make editable", 0, 0, "The selected link becomes objects of this document",
     [](const PanelContext& e) { return bool(selected_link(e)); }, make_link_editable},
    {"edit.merge_materials", "Merge equal materials", 0, 0,
     "One material instead of several that are equal and called the same but for a number", has_scene, merge_materials},
    {"edit.find", "Find anything...", ImGuiMod_Ctrl | ImGuiKey_P, 0,
     "Any action, panel, object, group, light, material or camera by a part of its name", nullptr,
     [](Editor& e) { e.panel_state->palette.asked = true; }},
    {"edit.drop", "Drop to floor", ImGuiKey_End, 0, "Lowers the selected objects until they touch what is below",
     has_objects, drop_to_floor},
    {"edit.arrange", "Arrange...", ImGuiMod_Ctrl | ImGuiMod_Shift | ImGuiKey_A, 0,
     "A panel to align, distribute, mirror, repeat and replace the selection", has_scene, show_arrange},
    {"edit.array", "Array...", ImGuiMod_Ctrl | ImGuiMod_Shift | ImGuiKey_D, 0,
     "Copies in a line, a circle, a grid or along a path, which change with their numbers until they are kept",
     has_objects, ask_for_array},
    {"edit.mirror_x", "Mirror x", 0, 0, "Mirrors the selection at its centre, along the world's x axis", has_selection,
     mirror<0>},
    {"edit.mirror_y", "Mirror y", 0, 0, "Mirrors the selection at its centre, along the world's y axis", has_selection,
     mirror<1>},
    {"edit.mirror_z", "Mirror z", 0, 0, "Mirrors the selection at its centre, along the world's z axis", has_selection,
     mirror<2>},
    {"edit.replace", "Replace by the last selected", 0, 0,
     "Puts copies of the last selected thing in the places of the others, scaled to their size",
     [](const PanelContext& e) { return e.selection.instances().size() > 1; }, run<replace_by_last>},
    {"edit.replace_copied", "Replace by the copied", 0, 0,
     "Puts copies of what was copied in the places of the selected things, scaled to their size",
     [](const PanelContext& e) { return has_objects(e) && !e.copied.instances.empty(); }, run<replace_by_copied>},
    {"edit.highlight", "Highlight here", 0, 0,
     "Click a surface: the selected light or lamp goes around it, at its distance, to where the surface reflects it "
     "to the view",
     [](const PanelContext& e) { return can_solo(e); }, run<point_highlight>},
    {"edit.place_texture", "Place texture", ImGuiKey_P, 0,
     "A frame on the active object moves, turns and scales its texture in the picture", has_objects,
     run<begin_placing>},
    {"edit.project_texture", "Project texture...", 0, 0,
     "Texture coordinates for the selected objects, from the front of each side (box projection)", has_objects,
     run<project_texture_dialog>},
    {"select.all", "All", ImGuiMod_Ctrl | ImGuiKey_A, ImGuiKey_A, "Select every visible object that is not locked",
     has_scene, select_all},
    {"select.none", "None", ImGuiKey_Escape, 0,
     "Clear the selection; leave the entered group; first close the help, end measuring, placing a texture or the "
     "region, or remove the array that is being made",
     [](const PanelContext& e) {
         return e.panel_open("Help") || e.viewport.measurement.on || e.viewport.region.active() || has_selection(e) ||
                e.selection.entered();
     },
     [](Editor& e) {
         if (e.viewport.placing.on) return end_placing(e);
         if (e.viewport.measurement.on) return void(e.viewport.measurement = {});
         if (e.viewport.region.active()) return e.viewport.region.end();
         if (e.panel_open("Help")) return e.open_panel("Help", false);
         if (cancel_array(e)) return;
         e.selection.clear();
         e.selection.enter({});
     }},
    {"select.whole_things", "Whole things", ImGuiMod_Shift | ImGuiKey_C, 0,
     "A click takes all parts of a thing (a chair of 20 objects); a double click goes into it. Off: single objects and "
     "groups",
     nullptr,
     [](Editor& e) {
         e.preferences.whole_things = e.selection.whole_things = !e.selection.whole_things;
         e.selection.enter({});
     },
     [](const PanelContext& e) { return e.selection.whole_things; }},
    {"select.touching", "What touches it", ImGuiKey_C, 0,
     "Adds the objects that the selection touches, and those that these touch: a whole chair, or a table with the "
     "things on it. "
     "Much larger objects, such as the floor, are excluded",
     has_objects, select_touching},
    {"select.hide", "Hide", ImGuiKey_H, 0, "Hide the selected objects, or switch the selected light off", has_selection,
     [](Editor& e) { set_hidden(e, true); }},
    {"select.isolate", "Isolate", ImGuiMod_Shift | ImGuiKey_H, 0, "Hides all other objects (lights stay on)",
     has_objects, isolate},
    {"select.show_all", "Show all", ImGuiMod_Alt | ImGuiKey_H, 0, "Shows hidden objects", has_scene, show_all},
    {"select.shadow_floor", "Add shadow catcher floor", 0, 0,
     "Lays a floor below everything that is visible: not seen itself, it takes the shadows of objects, which then "
     "stand in a photograph, or before a colour or nothing",
     has_scene, add_shadow_floor},
    {"select.lock", "Lock", ImGuiMod_Ctrl | ImGuiKey_L, 0, "Clicks no longer select these objects", has_objects,
     [](Editor& e) {
         for (const InstanceId id : e.selection.instances())
             e.locked.insert(id.value);
         e.selection.clear();
     }},
    {"select.unlock_all", "Unlock all", 0, 0, "Clicks can select every object again",
     [](const PanelContext& e) { return !e.locked.empty(); }, [](Editor& e) { e.locked.clear(); }},
    {"look.new", "New look", ImGuiMod_Ctrl | ImGuiMod_Shift | ImGuiKey_L, 0,
     "Records how things are now, to go back to: places, visibility, materials, lights, sky, exposure and camera",
     has_scene, run<new_look>},
    {"look.variants", "Looks from variants", 0, 0, "A look for each material variant of the document's glTF file",
     has<has_variants>, run<looks_from_variants>},
    {"look.next", "Next look", ImGuiKey_PageDown, 0, "Go to the next look", has<has_looks>,
     [](Editor& e) { step_look(e, 1); }},
    {"look.previous", "Previous look", ImGuiKey_PageUp, 0, "Go to the previous look", has<has_looks>,
     [](Editor& e) { step_look(e, -1); }},
    {"look.keep", "Keep picture", ImGuiKey_K, 0,
     "Puts the picture aside, with its scene, to compare with; J held over the picture shows it", has_scene,
     run<keep_picture>},
    {"view.frame_selected", "Frame selected", ImGuiKey_F, ImGuiKey_KeypadDecimal,
     "Move the camera so that the selection fills the picture", has_selection,
     [](Editor& e) { frame_bounds(e, e.selection.bounds(e.scene())); }},
    {"view.frame_all", "Frame all", ImGuiKey_Home, 0, "Move the camera so that everything is visible", has_scene,
     [](Editor& e) { frame_bounds(e, scene::world_bounds(e.scene())); }},
    {"view.file_camera", "Camera of the file", ImGuiMod_Shift | ImGuiKey_Home, 0,
     "To the camera's position when the file was opened",
     [](const PanelContext& e) { return e.opened_camera() != nullptr; },
     [](Editor& e) { e.look_from(e.opened_camera()->camera_to_world, {}, "Camera of the file"); }},
    {"view.back", "Back", ImGuiKey_LeftBracket, 0, "To the previous view; does not undo changes",
     [](const PanelContext& e) { return e.views.can_back(); }, [](Editor& e) { e.views.back(); }},
    {"view.forward", "Forward", ImGuiKey_RightBracket, 0, "To the next view",
     [](const PanelContext& e) { return e.views.can_forward(); }, [](Editor& e) { e.views.forward(); }},
    {"view.camera", "Look through the camera", ImGuiMod_Ctrl | ImGuiKey_Home, 0,
     "To the scene's camera, which navigation does not move", view_is_apart,
     [](Editor& e) { e.views.go(std::nullopt); }},
    {"view.set_camera", "Set camera to view", ImGuiMod_Ctrl | ImGuiMod_Shift | ImGuiKey_Home, 0,
     "Moves the scene's camera here; exports and other programs use it", view_is_apart, set_camera_to_view},
    {"view.lock_camera", "Lock camera", 0, 0,
     "Navigation does not move the scene's camera. Off: the camera follows, and each move can be undone", nullptr,
     [](Editor& e) { e.view.camera_locked = !e.view.camera_locked; },
     [](const PanelContext& e) { return e.view.camera_locked; }},
    {"view.bookmark", "Bookmark view", ImGuiKey_B, 0, "Bookmark this view; it is saved with the scene", has_scene,
     bookmark},
    {"view.next_bookmark", "Next bookmark", ImGuiMod_Shift | ImGuiKey_B, 0, "Go to the next bookmarked view",
     [](const PanelContext& e) { return e.scene().cameras.live() > 1; }, next_bookmark},
    {"view.gizmo_select", "Select tool", ImGuiKey_Q, 0, "No handles", nullptr, set_gizmo<GizmoMode::select>,
     is_gizmo<GizmoMode::select>},
    {"view.gizmo_move", "Move tool", ImGuiKey_W, ImGuiKey_G,
     "Handles to move. Shift: a copy, Ctrl: in steps, Alt: up and down", nullptr, set_gizmo<GizmoMode::move>,
     is_gizmo<GizmoMode::move>},
    {"view.gizmo_rotate", "Rotate tool", ImGuiKey_E, ImGuiKey_R, "Handles to rotate. Shift: a copy, Ctrl: in steps",
     nullptr, set_gizmo<GizmoMode::rotate>, is_gizmo<GizmoMode::rotate>},
    {"view.gizmo_scale", "Scale tool", ImGuiKey_R, ImGuiKey_S, "Handles to scale. Shift: a copy, Ctrl: in steps",
     nullptr, set_gizmo<GizmoMode::scale>, is_gizmo<GizmoMode::scale>},
    {"view.local", "Local axes", ImGuiKey_L, 0, "Handles along the object's own axes instead of the world's", nullptr,
     [](Editor& e) { e.view.local_axes = !e.view.local_axes; },
     [](const PanelContext& e) { return e.view.local_axes; }},
    {"view.collide", "Collide", ImGuiMod_Ctrl | ImGuiKey_K, 0,
     "Moved things stop at others, slide along them and rest on them. Shift, during a drag, lets them through", nullptr,
     [](Editor& e) { e.preferences.collide = !e.preferences.collide; },
     [](const PanelContext& e) { return e.preferences.collide; }},
    {"view.denoise", "Denoise", ImGuiKey_N, 0, "Show the denoised picture", nullptr,
     [](Editor& e) { e.view.denoise = !e.view.denoise; }, [](const PanelContext& e) { return e.view.denoise; }},
    {"view.exposure", "False-colour exposure", ImGuiMod_Shift | ImGuiKey_E, 0,
     "The picture's brightness in stops from middle grey, and what is cut off to black and white", has_scene,
     toggle_exposure, shows_exposure},
    {"view.solo_light", "Solo light", ImGuiMod_Shift | ImGuiKey_L, 0,
     "In the view, only the selected lights shine; again: no longer. Files are not changed",
     [](const PanelContext& e) { return can_solo(e); }, run<solo_selected>},
    {"view.all_lights", "All lights", 0, 0, "Ends all muting and soloing of lights",
     [](const PanelContext& e) { return e.panel_state->lights.any(); },
     [](Editor& e) { e.panel_state->lights.clear(); }},
    {"view.region", "Render region", ImGuiMod_Ctrl | ImGuiKey_B, 0,
     "Drag a rectangle in the picture: only there it is refined, until Esc or its close button", has_scene,
     [](Editor& e) {
         const bool active = e.viewport.region.active();
         e.viewport.region.end();
         e.viewport.region.choosing = !active;
     },
     [](const PanelContext& e) { return e.viewport.region.active(); }},
    {"view.overlays", "Overlays", ImGuiKey_V, 0, "Outlines, handles, numbers and messages over the picture", nullptr,
     [](Editor& e) { e.view.show_overlays = !e.view.show_overlays; },
     [](const PanelContext& e) { return e.view.show_overlays; }},
    {"view.inspect", "Pixel values", ImGuiKey_I, 0, "Radiance, error, object and distance of the pixel under the mouse",
     nullptr, [](Editor& e) { e.view.inspect_pixels = !e.view.inspect_pixels; },
     [](const PanelContext& e) { return e.view.inspect_pixels; }},
    {"view.panels", "Panels", ImGuiKey_Tab, 0, "Show or hide all panels", nullptr,
     [](Editor& e) { e.view.show_panels = !e.view.show_panels; },
     [](const PanelContext& e) { return e.view.show_panels; }},
    {"view.light_theme", "Light theme", 0, 0, "Dark text on light panels, for bright rooms", nullptr,
     [](Editor& e) { e.preferences.theme = e.preferences.theme == Theme::light ? Theme::dark : Theme::light; },
     [](const PanelContext& e) { return e.preferences.theme == Theme::light; }},
    {"view.reset_layout", "Reset layout", 0, 0, "Restores the initial layout of the panels", nullptr,
     [](Editor& e) { e.reset_layout(); }},
    {"show.picture", "Picture", ImGuiMod_Alt | ImGuiKey_1, 0, "The path-traced picture", has_scene,
     show_layer<view::picture_layer>, is_layer<view::picture_layer>},
    {"show.clay", "Clay", ImGuiMod_Alt | ImGuiKey_2, 0, "The shape of things alone; nothing is traced meanwhile",
     has_scene, show_layer<view::clay_layer>, is_layer<view::clay_layer>},
    {"show.wires", "Wireframe", ImGuiMod_Alt | ImGuiKey_3, 0, "The edges of all triangles that are not behind others",
     has_scene, show_layer<view::wire_layer>, is_layer<view::wire_layer>},
    {"show.uv", "UV checker", ImGuiMod_Alt | ImGuiKey_4, 0, "Texture coordinates as chequers", has_scene,
     show_layer<view::uv_layer>, is_layer<view::uv_layer>},
    {"show.objects", "Object colours", ImGuiMod_Alt | ImGuiKey_5, 0, "Each object in a colour of its own", has_scene,
     show_layer<objects_layer>, is_layer<objects_layer>},
    {"show.materials", "Material colours", ImGuiMod_Alt | ImGuiKey_6, 0, "Each material in a colour of its own",
     has_scene, show_layer<materials_layer>, is_layer<materials_layer>},
    {"show.samples", "Samples per pixel", ImGuiMod_Alt | ImGuiKey_7, 0, "Where adaptive sampling works most", has_scene,
     show_layer<view::samples_layer>, is_layer<view::samples_layer>},
    {"show.error", "Error", ImGuiMod_Alt | ImGuiKey_8, 0, "The estimated relative error of each pixel", has_scene,
     show_layer<view::error_layer>, is_layer<view::error_layer>},
    {"show.grid", "Grid", ImGuiKey_G, ImGuiMod_Shift | ImGuiKey_G, "A grid on the floor, behind what stands before it",
     nullptr, [](Editor& e) { e.view.show_grid = !e.view.show_grid; },
     [](const PanelContext& e) { return e.view.show_grid; }},
    {"show.axes", "Axes", 0, 0, "The axes in the picture's corner; a click looks along one", nullptr,
     [](Editor& e) { e.view.show_axes = !e.view.show_axes; }, [](const PanelContext& e) { return e.view.show_axes; }},
    {"show.measure", "Measure", ImGuiKey_M, 0, "The distance between two points on surfaces, by two clicks", has_scene,
     [](Editor& e) { e.viewport.measurement = {.on = !e.viewport.measurement.on}; },
     [](const PanelContext& e) { return e.viewport.measurement.on; }},
    {"help.tour", "Tour", 0, 0, "Six steps on the example room: select, move, material, sky, camera, save", nullptr,
     start_tour},
    {"help.shortcuts", "Shortcuts and help", ImGuiMod_Shift | ImGuiKey_Slash, 0, "All shortcuts, and how to navigate",
     nullptr, [](Editor& e) { e.open_panel("Help", !e.panel_open("Help")); },
     [](const PanelContext& e) { return e.panel_open("Help"); }},
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

std::string key_text(ImGuiKeyChord key) {
    if (!key) return "";
    if (key == (ImGuiMod_Shift | ImGuiKey_Slash)) return "?"; // the character it types
    std::string text = ImGui::GetKeyChordName(key);
    // Keys with a printed character are named after it.
    static constexpr std::pair<std::string_view, std::string_view> signs[] = {
        {"LeftBracket", "["},  {"RightBracket", "]"},   {"Slash", "/"},    {"Comma", ","},
        {"Period", "."},       {"Minus", "-"},          {"Equal", "="},    {"KeypadDecimal", "Keypad ."},
        {"LeftArrow", "Left"}, {"RightArrow", "Right"}, {"UpArrow", "Up"}, {"DownArrow", "Down"}};
    for (const auto& [name, sign] : signs)
        if (text.ends_with(name)) return text.replace(text.size() - name.size(), name.size(), sign);
    return text;
}

std::string label_of(const PanelContext& e, const Action& action) {
    const std::string_view id = action.id;
    const scene::History& history = e.session().history();
    const std::string_view step = id == "edit.undo"   ? history.undo_label()
                                  : id == "edit.redo" ? history.redo_label()
                                                      : std::string_view();
    if (step.empty()) return action.label;
    constexpr std::size_t most = 48; // bytes
    std::string text = fmt::format("{} {}", action.label, step.substr(0, most));
    if (step.size() > most) {
        while (!text.empty() && (static_cast<unsigned char>(text.back()) & 0xc0) == 0x80) // not inside a UTF-8 sequence
            text.pop_back();
        if (!text.empty() && (static_cast<unsigned char>(text.back()) & 0x80)) text.pop_back();
        text += "...";
    }
    return text;
}

void run_shortcuts(Editor& editor, const std::vector<ImGuiKeyChord>* keys) {
    const ImGuiIO& io = ImGui::GetIO();
    const auto pressed = [&](ImGuiKeyChord key) {
        return keys ? std::find(keys->begin(), keys->end(), key) != keys->end() : ImGui::IsKeyChordPressed(key);
    };
    if (editor.viewport.dragging()) { // an undo would remove the dragged things from under the mouse
        // With any modifiers: Shift while a copy is dragged.
        const bool escape =
            keys ? std::ranges::any_of(*keys,
                                       [](ImGuiKeyChord key) { return (key & ~ImGuiMod_Mask_) == ImGuiKey_Escape; })
                 : ImGui::IsKeyPressed(ImGuiKey_Escape, false);
        if (escape) editor.viewport.cancel(editor);
        return;
    }
    // While text is typed, a dialog is open, or the camera flies on WASD, keys have other meanings.
    const bool popup = ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
    // Dear ImGui closes menus and lists with Esc only where it also navigates by keys. Dialogs do it themselves.
    if (popup && keys && std::find(keys->begin(), keys->end(), ImGuiKey_Escape) != keys->end() &&
        !ImGui::GetTopMostPopupModal())
        ImGui::ClosePopupToLevel(0, true);
    if (io.WantTextInput || popup || ImGui::IsMouseDown(ImGuiMouseButton_Right)) return;
    const auto run = [&](auto&& wanted) {
        for (const Action& action : actions) {
            const ImGuiKeyChord key = key_of(action, editor.view.keys);
            if (key == ImGuiKey_Escape && editor.pick_tool) continue; // ends that, not the selection
            if (key && wanted(key)) editor.run(action.id);
        }
    };
    if (!keys) return run(pressed);
    for (const ImGuiKeyChord one : *keys) // each, in order: a slow frame may contain several equal ones
        run([&](ImGuiKeyChord key) { return key == one; });
}

EditContext::ActionState Editor::action_state(std::string_view id) const {
    const Action* action = find_action(id);
    if (!action) return {};
    return {.enabled = !action->enabled || action->enabled(*this),
            .checked = action->checked && action->checked(*this),
            .label = label_of(*this, *action),
            .key = key_text(key_of(*action, view.keys))};
}

void menu_item(EditContext& editor, std::string_view id) {
    const Action* action = find_action(id);
    if (!action) return;
    const auto state = editor.action_state(id);
    if (ImGui::MenuItem((state.label + "###" + action->id).c_str(), state.key.c_str(), state.checked, state.enabled))
        editor.run(id);
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_ForTooltip | ImGuiHoveredFlags_AllowWhenDisabled))
        ImGui::SetTooltip("%s", action->tooltip);
    editor.mark(action->id);
}

bool action_button(EditContext& editor, std::string_view id, const char* label) {
    const Action* action = find_action(id);
    if (!action) return false;
    const auto state = editor.action_state(id);
    ImGui::BeginDisabled(!state.enabled);
    if (state.checked) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_HeaderActive));
    const bool pressed = ImGui::Button(label ? label : action->label);
    if (state.checked) ImGui::PopStyleColor();
    ImGui::EndDisabled();
    editor.mark(action->id);
    if (ImGui::IsItemHovered(ImGuiHoveredFlags_ForTooltip | ImGuiHoveredFlags_AllowWhenDisabled))
        ImGui::SetTooltip("%s%s%s%s\n%s", action->label, state.key.empty() ? "" : " (", state.key.c_str(),
                          state.key.empty() ? "" : ")", action->tooltip);
    if (pressed) editor.run(id);
    return pressed;
}

} // namespace restage::editor

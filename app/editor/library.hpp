// SPDX-License-Identifier: Apache-2.0
// Library: materials to choose from: presets of Restage (share/restage/materials), of plugins (a folder `presets`
// beside plugin.json) and of the user (`materials` in the configuration folder), and the materials of the open scene
// and of other scenes' files.
#pragma once

#include "contexts.hpp"
#include "document/preset.hpp"
#include "shown_scene.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace restage::editor {

struct LibraryItem {
    std::string key; // "material:17" of the scene; "preset:/folder/gold.json"; "file:/folder/room.pbrt#17"
    std::string name, category;
    std::string from; // "Restage", "yours", a plugin's name, "this scene", "room.pbrt"
    std::shared_ptr<const document::Preset> preset; // null: of the scene
    scene::Id<scene::Material> material; // of the scene
};
inline constexpr const char* in_this_scene = "In this scene"; // category of its materials
inline constexpr const char* own_presets = "Your presets"; // `from` of the user's

struct LibraryState { // of the panel
    bool loaded = false;
    std::uint64_t plugins = 0; // plugin::Registry::version, when it was loaded
    std::vector<LibraryItem> presets; // by category and name
    std::vector<LibraryItem> borrowed; // of other scenes' files, since the start
    std::string search, category; // "" = all

    // What hovering shows on the selection.
    std::string hovered; // key of the ball under the mouse
    double since = 0; // [s], as ImGui::GetTime
    std::vector<InstanceId> on; // the selection that it is tried on
    Trial trial;
    std::uint64_t trials = 0; // so far
    std::string tried; // its key
    std::string done; // applied by a click: not tried again until the mouse has left it
    int frame = -1; // ImGui::GetFrameCount when the panel was last drawn
};

// Every preset, read on first use and when plugins change. Unreadable files are reported once.
const std::vector<LibraryItem>& presets_of(DocumentContext& editor);
std::vector<LibraryItem> materials_of(const DocumentContext& editor); // of the scene
std::optional<LibraryItem> library_item(DocumentContext& editor, std::string_view key);
// Categories of the presets, in alphabetical order.
std::vector<std::string> categories_of(DocumentContext& editor);

// Builds the edit that gives it to these objects, and texture coordinates to those that need some, of which a
// notice tells. Its images must have been decoded.
EditContext::Builder giving(DocumentContext& editor, const LibraryItem& item, std::vector<InstanceId> objects);
// Calls `then` with the item once its images are decoded: at once if there are none to decode.
void with_images(PanelUi& editor, LibraryItem item, std::function<void(PanelUi&, const LibraryItem&)> then);
// To the selection, as one step.
void give_to_selection(SelectContext& editor, const LibraryItem& item);

// Once per drawn panel: the ball under the mouse is tried on the selection after a moment, and until a moment after the
// mouse has left. Never with nothing selected.
void follow_hover(SelectContext& editor, const LibraryItem* under_mouse);
// What the picture shows besides the document now.
Trial current_trial(const LibraryState& state);

// The materials of a scene's file or project, with their textures, for the library until the program ends: read in the
// background. Reading a file again replaces them.
void borrow_materials(DocumentContext& editor, const std::filesystem::path& file);
void ask_borrow_materials(EditContext& editor); // which file

// A preset's file from outside: goes to the object there; without one, a copy goes into the user's presets.
void drop_preset(PanelContext& editor, const std::filesystem::path& file, InstanceId on);

// A dialog that writes the material into the user's folder, with its textures.
void ask_save_preset(EditContext& editor, scene::Id<scene::Material> material);

// While a ball is dragged over this point of the window: outlines the object there, and says what a drop does.
void preview_material_drop(PanelContext& editor, const std::string& key, ImVec2 screen);
void drop_material(PanelContext& editor, const std::string& key, ImVec2 screen);
void drop_material(PanelContext& editor, const LibraryItem& item, InstanceId on);
// The payload of drags: a key.
inline constexpr const char* material_payload = "restage.material";

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
// Saving: the File menu's operations on the document and its files. Operations that would lose unsaved work ask first.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace restage::plugin {
class Registry;
}

namespace restage::editor {

class Editor;
class PanelContext;
struct FileFilter; // file_browser.hpp
using Then = std::function<void(Editor&)>;

// Calls it immediately if nothing is unsaved; else after Save or Discard, and never after Cancel. `doing`: "opening
// another scene".
void ask_unsaved(Editor& editor, const char* doing, Then then);

// What can be opened: scenes of the importers, and projects.
std::vector<FileFilter> scene_filters(const plugin::Registry& registry, bool projects);
void new_scene(Editor& editor); // a studio: a floor, a neutral sky, a camera
void open_dialog(Editor& editor);
void insert_dialog(Editor& editor);
void link_dialog(Editor& editor);
void save(Editor& editor, Then then = {}); // to its previous file, else save_as
void save_as(Editor& editor, Then then = {});
void revert(Editor& editor);
void export_dialog(PanelContext& editor);
void save_image_dialog(PanelContext& editor);
// Shows what could not be written, why, and how to proceed: a fading notice could be missed, and work lost.
struct WriteFailure {
    std::string title, reason; // "The project was not saved"
    std::function<void()> again; // retries
    std::function<void()> elsewhere; // opens the file browser for another place
};
void show_failure(PanelContext& editor, WriteFailure failure);
void recent_menu(PanelContext& editor); // a submenu
// Renders the scene at its film's full size, by a separate renderer in the background, while editing continues.
void final_render_dialog(PanelContext& editor);
// At the start, if an earlier run ended with unsaved work; else does nothing.
void offer_recovery(Editor& editor);

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
// Saving: what the File menu does to the document and its files. Whatever would lose unsaved work asks first.
#pragma once

#include <functional>
#include <string>

namespace restage::editor {

class Editor;
class PanelContext;
using Then = std::function<void(Editor&)>;

// Does it at once if nothing is unsaved; else after Save or Discard, and not at all after Cancel. `doing`: "opening
// another scene".
void ask_unsaved(Editor& editor, const char* doing, Then then);

void new_scene(Editor& editor); // a studio: a floor, a neutral sky, a camera
void open_dialog(Editor& editor);
void insert_dialog(Editor& editor);
void save(Editor& editor, Then then = {}); // where it was saved before, else save_as
void save_as(Editor& editor, Then then = {});
void revert(Editor& editor);
void export_dialog(PanelContext& editor);
void save_image_dialog(PanelContext& editor);
// What could not be written, why, and how to proceed: a fading notice would be missed, and work lost.
struct WriteFailure {
    std::string title, reason; // "The project was not saved"
    std::function<void()> again; // retries
    std::function<void()> elsewhere; // asks for another place
};
void show_failure(PanelContext& editor, WriteFailure failure);
void recent_menu(PanelContext& editor); // a submenu
// The scene at its film's full size, by a renderer of its own in the background, while editing goes on.
void final_render_dialog(PanelContext& editor);
// At the start, if an earlier run ended with unsaved work; else does nothing.
void offer_recovery(Editor& editor);

} // namespace restage::editor

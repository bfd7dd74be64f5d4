// SPDX-License-Identifier: Apache-2.0
// Saving: what the File menu does to the document and its files. Whatever would lose unsaved work asks first.
#pragma once

#include <functional>
#include <string>

namespace restage::editor {

class Editor;
using Then = std::function<void(Editor&)>;

// Does it at once when nothing is unsaved; else after Save or Discard, and not at all after Cancel. `doing`: "opening
// another scene".
void ask_unsaved(Editor& editor, const char* doing, Then then);

void new_scene(Editor& editor); // a studio: a floor, a neutral sky, a camera
void open_dialog(Editor& editor);
void insert_dialog(Editor& editor);
void save(Editor& editor, Then then = {}); // where it was saved before, else save_as
void save_as(Editor& editor, Then then = {});
void revert(Editor& editor);
void export_dialog(Editor& editor);
void save_image_dialog(Editor& editor);
// What could not be written, and why, with the ways out of it: a note that fades would be missed, and work lost.
struct WriteFailure {
    std::string title, reason; // "The project was not saved"
    Then again; // the same once more
    Then elsewhere; // asks for another place
};
void show_failure(Editor& editor, WriteFailure failure);
void recent_menu(Editor& editor); // a submenu

} // namespace restage::editor

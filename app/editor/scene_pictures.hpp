// SPDX-License-Identifier: Apache-2.0
// Small pictures of scene files, as they were last seen in the editor: kept in the configuration folder under a name
// made of the file's path and its time, so a file that has changed since has none.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace restage::editor {

class PanelContext;
class PanelUi;

// Keeps the shown picture as that of the document's file. Nothing happens if there is none or it has unsaved changes.
// Renders nothing; takes some milliseconds.
void keep_scene_picture(PanelContext& editor);
// Draws the picture of that file in a square of this side, or an icon if there is none. `mark`: its name for tests.
// `time`: when the file was changed; none = it is asked for.
void draw_scene_picture(PanelUi& editor, const std::filesystem::path& file, float side, const std::string& mark,
                        std::optional<std::filesystem::file_time_type> time = {});
// As a tooltip of the last item, with the file's path.
void scene_picture_tip(PanelUi& editor, const std::filesystem::path& file);

} // namespace restage::editor

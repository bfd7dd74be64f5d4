// SPDX-License-Identifier: Apache-2.0
// Links in the editor (scene/links.hpp): the whole of one is selected, and files that change on disk are read again.
#pragma once

#include "scene/id.hpp"
#include "scene/scene.hpp"

#include <filesystem>
#include <map>
#include <string>

namespace restage::editor {

class Editor;
class PanelUi;
class SelectContext;

class LinkWatch {
  public:
    void follow(Editor& e); // once a frame, after the panels

  private:
    void look_at_files(Editor& e);

    scene::Version seen_ = ~scene::Version(0); // of the groups
    bool any_ = false;
    double looked_at_ = -1e9; // [s], as ImGui::GetTime: at once when there is a link
    std::map<std::string, std::filesystem::file_time_type> times_; // of linked files
};

// The link that the active object of the selection is in; none if it is in none.
scene::Id<scene::Group> selected_link(const SelectContext& e);
// "linked", beside its name, and the file in a tooltip; nothing if it is not a link.
void link_note(PanelUi& e, const scene::Group& group);

void reload_links(Editor& e); // all of them, on a thread
void make_link_editable(Editor& e); // the selected one
void merge_materials(Editor& e); // scene/share_materials.hpp

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
// Keys in dialogs. The program does not let Dear ImGui navigate by keys, since keys act on the picture.
#pragma once

namespace restage::editor {

// While it exists Tab and arrows go through the widgets, and Space and Enter use them.
class KeyNavigation {
  public:
    KeyNavigation();
    ~KeyNavigation();
    KeyNavigation(const KeyNavigation&) = delete;
    KeyNavigation& operator=(const KeyNavigation&) = delete;

  private:
    bool was_on_;
};

// Esc leaves the dialog; false where it only closed a list that was open. Once a frame. `list_open`: of the frame
// before.
bool dialog_escape(bool& list_open);

} // namespace restage::editor

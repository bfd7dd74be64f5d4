// SPDX-License-Identifier: Apache-2.0
// Marks: names of things drawn in the last frame, for tests that control the program from outside.
#pragma once

#include <map>
#include <string>
#include <string_view>

struct ImVec2;

namespace restage::editor {

class Marks {
  public:
    struct Mark {
        float x0 = 0, y0 = 0, x1 = 0, y1 = 0; // its rectangle in the window
        unsigned item = 0; // ImGuiID; 0 = none
    };
    void clear() { marks_.clear(); } // at the start of a frame
    // The last item, a rectangle, the tab of the current window. Ignored until the window has settled.
    void item(const std::string& name);
    void area(const std::string& name, const ImVec2& lower, const ImVec2& upper);
    void tab(const std::string& name);
    const Mark* find(std::string_view name) const;
    const std::map<std::string, Mark, std::less<>>& all() const { return marks_; }

  private:
    std::map<std::string, Mark, std::less<>> marks_;
};

} // namespace restage::editor

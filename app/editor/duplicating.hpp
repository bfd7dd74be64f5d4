// SPDX-License-Identifier: Apache-2.0
// Duplicating the selection (Ctrl+D). Another one while the copies are still selected continues the row: the next copy
// is to the last one as that is to its original, also after it was moved, turned or scaled.
#pragma once

#include "selection.hpp"

#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace restage::editor {

class Editor;

// The latest copies, while they are what is selected: by Ctrl+D, or dragged with Shift.
class LatestCopies {
  public:
    // `original`: the place of the last of the originals; `move`: by which the copies were displaced when they were
    // made.
    void made(std::vector<InstanceId> copies, const glm::dmat4& original, const glm::dmat4& move);
    void made(scene::Id<scene::Light> copy, const glm::dmat4& original, const glm::dmat4& move);
    // Forgets them if something else is selected, or undo has removed them; call once per frame.
    void follow(const Selection& selection);
    // The displacement of the next copies; none if there are no such copies, or they are where their originals were.
    std::optional<glm::dmat4> next(const scene::Scene& scene) const;

  private:
    std::vector<InstanceId> copies_; // the last one's place is compared
    scene::Id<scene::Light> light_;
    glm::dmat4 original_{1}, move_{1};
};

void duplicate_selected(Editor& editor);

} // namespace restage::editor

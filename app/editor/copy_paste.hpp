// SPDX-License-Identifier: Apache-2.0
// The system clipboard: objects, lights and materials, also from another Restage window.
#pragma once

#include "scene/bounds.hpp"
#include "scene/scene.hpp"

#include <string>
#include <utility>
#include <vector>

namespace restage::editor {

class Editor;
class SelectContext;

// What this window put into the clipboard last, to recognise it.
struct Copied {
    std::string text;
    std::vector<std::pair<scene::Id<scene::Instance>, scene::Instance>> instances; // as they were
};

void copy_selected(SelectContext& editor);
void copy_material(SelectContext& editor, scene::Id<scene::Material> material);
// Objects and lights are put where they were, beside existing ones; a material goes to what is selected.
void paste(Editor& editor);
bool newer_in_clipboard(const SelectContext& editor); // something from another window
// To the right of something as large as this, seen from the camera, along a world axis: where a copy of it is visible.
glm::dvec3 aside(const SelectContext& editor, const scene::Bounds& bounds);

} // namespace restage::editor

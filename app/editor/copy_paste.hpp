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

// This window's last clipboard content, to recognise it.
struct Copied {
    std::string text;
    std::vector<std::pair<scene::Id<scene::Instance>, scene::Instance>> instances; // as they were
};

void copy_selected(SelectContext& editor);
void copy_material(SelectContext& editor, scene::Id<scene::Material> material);
// Objects and lights keep their places, or are put next to existing ones; a material is assigned to the selection.
void paste(Editor& editor);
bool newer_in_clipboard(const SelectContext& editor); // something from another window
// Beside the thing, where a copy is visible: see query::visible_offset.
glm::dvec3 aside(const SelectContext& editor, const scene::Bounds& bounds);

} // namespace restage::editor

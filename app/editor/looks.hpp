// SPDX-License-Identifier: Apache-2.0
// Looks in the editor: what menus, keys and the panel Looks do with them (document/looks.hpp).
#pragma once

#include "scene/scene.hpp"

#include <cstddef>
#include <string>

namespace restage::editor {

class DocumentContext;
class SelectContext;

// The scene with its camera at the picture's viewpoint.
scene::Scene scene_as_seen(const SelectContext& editor);

void new_look(SelectContext& editor); // as seen
void update_look(SelectContext& editor, std::size_t index); // as seen
void go_to_look(SelectContext& editor, std::size_t index); // the view goes to its camera
void step_look(SelectContext& editor, int by); // to the next or previous one, around
// A look for each material variant of the document's file, which is read on a thread.
void looks_from_variants(DocumentContext& editor);
bool has_variants(const DocumentContext& editor);
bool has_looks(const DocumentContext& editor);
bool has_current_look(const DocumentContext& editor);

// What differs between the picture's scene and the look: "2 objects, sky, camera"; "" = nothing.
std::string difference_from_look(const SelectContext& editor, std::size_t index);

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
// Highlight here: the selected light, or lamp, is placed by pointing at the surface that is to reflect it to the view.
#pragma once

namespace restage::editor {

class SelectContext;

// The next click in the picture is the highlight's place. The light keeps its distance from there; its move is one undo
// step. A light that something hides from there is placed nevertheless, and a notice says so.
void point_highlight(SelectContext& editor);

} // namespace restage::editor

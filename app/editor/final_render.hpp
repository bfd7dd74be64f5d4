// SPDX-License-Identifier: Apache-2.0
// Final pictures: the scene at its film's full size, by a renderer of its own in the background, while editing goes on.
#pragma once

namespace restage::editor {

class Editor;

void final_render_dialog(Editor& editor);

} // namespace restage::editor

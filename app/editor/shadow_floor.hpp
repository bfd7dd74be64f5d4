// SPDX-License-Identifier: Apache-2.0
// The action "Add shadow catcher floor".
#pragma once

namespace restage::editor {

class Editor;
void add_shadow_floor(Editor&);

} // namespace restage::editor

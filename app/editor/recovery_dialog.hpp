// SPDX-License-Identifier: Apache-2.0
// What the program says at its start when an earlier one ended with unsaved work.
#pragma once

namespace restage::editor {

class Editor;

void offer_recovery(Editor& editor); // nothing when there is nothing

} // namespace restage::editor

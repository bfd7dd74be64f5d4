// SPDX-License-Identifier: Apache-2.0
// "Pack project": the document with all files that it needs, in a folder or a zip file (document/pack.hpp).
#pragma once

namespace restage::editor {

class PanelContext;

// Asks where, and packs in the background. The document and its path stay as they are.
void pack_dialog(PanelContext& editor);

} // namespace restage::editor

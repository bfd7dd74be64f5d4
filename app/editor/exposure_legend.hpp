// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "contexts.hpp"

#include <imgui.h>

namespace restage::editor {

// The legend of the false-colour exposure, at the right edge of the picture's rectangle.
void draw_exposure_legend(PanelUi& editor, ImVec2 corner, ImVec2 size);

} // namespace restage::editor

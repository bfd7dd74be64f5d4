// SPDX-License-Identifier: Apache-2.0
// Blurring the sky's image in the background (scene/sky_blur.hpp).
#pragma once

namespace restage::editor {

class EditContext;

// The row of the Scene panel: an angle, and a button.
void blur_row(EditContext& editor);

} // namespace restage::editor

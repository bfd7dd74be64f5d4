// SPDX-License-Identifier: Apache-2.0
// The sections of the Scene panel, and light for scenes without any: a sky, lights.
#pragma once

#include "contexts.hpp"

namespace restage::editor {

class PictureView;

void choices_section(EditContext& editor); // of the file: its scenes, its variants
void sky_section(EditContext& editor);
void camera_section(SelectContext& editor);
void film_section(EditContext& editor);
void development_section(EditContext& editor);
void lights_section(SelectContext& editor);
void render_section(EditContext& editor, PictureView& picture);

// False if nothing in the scene emits light: its picture is black.
bool has_light(const DocumentContext& editor);
// As one undo step: document::light_studio.
void light_with_studio(EditContext& editor);
// Sets the image as the sky; it is read on another thread.
void use_as_sky(EditContext& editor, const std::string& file);

} // namespace restage::editor

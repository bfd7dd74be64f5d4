// SPDX-License-Identifier: Apache-2.0
// The sections of the Scene panel, and what the scene has too little of to be seen: a sky, lights.
#pragma once

#include "editor.hpp"

namespace restage::editor {

void sky_section(Editor& editor);
void camera_section(Editor& editor);
void film_section(Editor& editor);
void lights_section(Editor& editor);
void render_section(Editor& editor);

// False when nothing in the scene shines: its picture is black.
bool has_light(const Editor& editor);
// As one step: document::light_studio.
void light_with_studio(Editor& editor);
// The image becomes the sky; read on another thread.
void use_as_sky(Editor& editor, const std::string& file);

} // namespace restage::editor

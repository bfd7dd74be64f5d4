// SPDX-License-Identifier: Apache-2.0
// The sections of the Scene panel, and what a scene may lack to be visible: a sky, lights.
#pragma once

#include "panel_context.hpp"

namespace restage::editor {

void sky_section(PanelContext& editor);
void camera_section(PanelContext& editor);
void film_section(PanelContext& editor);
void lights_section(PanelContext& editor);
void render_section(PanelContext& editor);

// False if nothing in the scene emits light: its picture is black.
bool has_light(const PanelContext& editor);
// As one step: document::light_studio.
void light_with_studio(PanelContext& editor);
// The image becomes the sky; read on another thread.
void use_as_sky(PanelContext& editor, const std::string& file);

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
// The sections of the inspector. Each draws a header and, where it is open, what is under it.
#pragma once

#include "contexts.hpp"

namespace restage::editor {

void place_section(SelectContext& editor); // of the selected objects
void material_section(SelectContext& editor, scene::Id<scene::Material> material);
void emission_section(EditContext& editor, InstanceId instance);
void light_section(EditContext& editor, scene::Id<scene::Light> light); // a light without a surface

// Rows for a light's colour, its temperature and its strength, which together are `value`. True when changed.
bool light_value_rows(PanelUi& editor, glm::vec3& value, const char* strength_label, const char* unit,
                      const std::string& mark);

// The image becomes the texture of the main colour of what is selected; read on another thread.
void texture_for_selected(SelectContext& editor, const std::string& file);

// A swatch of the material's main colour.
glm::vec3 swatch_color(const DocumentContext& editor, const scene::Material& material);

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
// The sections of the inspector. Each draws a header and, if it is open, its contents.
#pragma once

#include "contexts.hpp"

namespace restage::editor {

void place_section(SelectContext& editor); // of the selected objects
void material_section(SelectContext& editor, scene::Id<scene::Material> material);
void emission_section(EditContext& editor, InstanceId instance);
void light_section(EditContext& editor, scene::Id<scene::Light> light); // a light without a surface

// Rows for a light's colour, temperature and strength, which together form `value`. True if changed.
bool light_value_rows(PanelUi& editor, glm::vec3& value, const char* strength_label, const char* unit,
                      const std::string& mark);

// Sets the image as the texture of the selection's main colour; it is read on another thread.
void texture_for_selected(SelectContext& editor, const std::string& file);

// A swatch of the material's main colour.
glm::vec3 swatch_color(const DocumentContext& editor, const scene::Material& material);

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
// Texture coordinates for objects that have none, by box projection (scene/box_projection.hpp).
#pragma once

#include "base/result.hpp"
#include "scene/edit.hpp"

#include <span>

namespace restage::editor {

class DocumentContext;
class SelectContext;

// Asks for the size of a repetition, and projects on the selection.
void project_texture_dialog(SelectContext& editor);

// The edit of a builder that gives the material a texture, followed by the projection for those of its objects whose
// mesh has no texture coordinates, with a notice. `scene`: before the edit.
Result<scene::Edit> project_where_needed(DocumentContext& editor, const scene::Scene& scene, Result<scene::Edit> edit,
                                         scene::Id<scene::Material> material);
// Likewise of one that gives these objects a material.
Result<scene::Edit> project_where_needed(DocumentContext& editor, const scene::Scene& scene, Result<scene::Edit> edit,
                                         std::span<const scene::Id<scene::Instance>> objects);

// In the inspector, below a material with textures: a warning if the object's mesh has no texture coordinates.
void missing_uv_note(SelectContext& editor);

} // namespace restage::editor

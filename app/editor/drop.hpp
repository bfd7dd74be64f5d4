// SPDX-License-Identifier: Apache-2.0
// The effect and target of a file dropped on the picture. PanelContext::drop carries it out.
#pragma once

#include "base/result.hpp"
#include "scene/edit.hpp"
#include "selection.hpp"

#include <imgui.h>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace restage::editor {

class PanelContext;
class SelectContext;

// The object under that point of the film ([0,1) each way), from the scene, as the picture may be out of date.
InstanceId target_at(const PanelContext& editor, glm::dvec2 film);
// The tooltip of a drag: replaces that of its source, see accept_asset(). `onto`: named by a mark, "" = nothing.
void drop_tip(PanelContext& editor, const std::string& text, const std::string& onto, ImVec2 screen);
// While it is dragged over that point: outlines the target object and describes the effect of a drop.
void preview_drop(PanelContext& editor, const std::filesystem::path& path, ImVec2 screen);

// Calls `then` with the material to change for these objects: immediately if no others share it; else
// asks whether to change it for all that share it, or to copy it for these only. `what`: "oak.png".
struct MaterialScope {
    bool alone = false; // a copy for these objects
    std::vector<InstanceId> objects;
};
void ask_scope(SelectContext& editor, const std::vector<InstanceId>& objects, const std::string& what,
               std::function<void(SelectContext&, const MaterialScope&)> then);

// `build` returns an edit of the material of `scope`, for a scene in which it was made unique if the user chose that.
Result<scene::Edit> edit_in_scope(
    const scene::Scene& scene, const MaterialScope& scope,
    const std::function<Result<scene::Edit>(const scene::Scene&, scene::Id<scene::Material>)>& build);

} // namespace restage::editor

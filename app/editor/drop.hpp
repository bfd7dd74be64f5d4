// SPDX-License-Identifier: Apache-2.0
// What a file that is let go over the picture does, and whom it would do it to. PanelContext::drop does it.
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

// While it is dragged over that point: outlines the object it would go to and says what would become of it.
void preview_drop(PanelContext& editor, const std::filesystem::path& path, ImVec2 screen);

// Calls `then` with the material that is to be changed for these objects: at once where nobody else has theirs; else
// asks whether all that share it are meant, or a copy shall be made for these alone. `what`: "oak.png".
struct MaterialScope {
    bool alone = false; // a copy for these objects
    std::vector<InstanceId> objects;
};
void ask_scope(PanelContext& editor, const std::vector<InstanceId>& objects, const std::string& what,
               std::function<void(PanelContext&, const MaterialScope&)> then);

// `build` makes an edit of the material of `scope`, on a scene in which it has been made unique where that is wanted.
Result<scene::Edit> edit_in_scope(
    const scene::Scene& scene, const MaterialScope& scope,
    const std::function<Result<scene::Edit>(const scene::Scene&, scene::Id<scene::Material>)>& build);

} // namespace restage::editor

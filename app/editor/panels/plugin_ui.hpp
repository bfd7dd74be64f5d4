// SPDX-License-Identifier: Apache-2.0
// The host's side of restage.inspector/1: a plugin describes its part of the inspector by the widgets of RestageUi1,
// and what the user changes there is asked of the editor as edits.
#pragma once

#include "panel_context.hpp"
#include "plugin/registry.hpp"

#include <functional>
#include <set>
#include <string>

namespace restage::editor {

struct PluginUi {
    PanelContext& editor;
    scene::Id<scene::Material> id;
    const scene::Material& material;
    const plugin::MaterialEntry& plugin;
    std::function<void(const model::Param&)> row; // the host's own row of a parameter
};

// Draws what the plugin has to show. Returns the ids of the parameters it showed.
std::set<std::string> draw_plugin_inspector(const plugin::Inspector& inspector, const PluginUi& ui);

} // namespace restage::editor

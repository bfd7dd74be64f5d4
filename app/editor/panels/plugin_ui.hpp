// SPDX-License-Identifier: Apache-2.0
// The host's side of RestageUi1 (restage/inspector.h): a plugin describes its inspector, or its panel, by widgets that
// name parameters; the caller stores the values.
#pragma once

#include "contexts.hpp"
#include "plugin/registry.hpp"
#include "scene/params.hpp"

#include <functional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace restage::editor {

struct PluginUi {
    SelectContext& editor;
    model::ParamTable table;
    const scene::ParamSet& values;
    std::string mark; // prefix of the widgets' names in tests: "material"
    std::string who;  // for messages: "org.example.velvet: its inspector"
    Blame blame;
    std::function<void(const model::Param&)> row; // the host's row of a parameter
    std::function<void(const model::Param&, scene::Value)> change; // during a drag
    std::function<void(std::string label, std::vector<std::pair<std::string, scene::Value>>)> set; // several at once
    std::function<bool(const std::string& action)> run = {}; // of a panel: false = not started
};

// Draws the plugin's widgets. Returns the ids of the parameters it showed.
std::set<std::string> draw_plugin_inspector(const plugin::Inspector& inspector, const PluginUi& ui);
// An error if the plugin threw an exception.
Result<> draw_plugin_panel(const plugin::PanelEntry& panel, const PluginUi& ui);

} // namespace restage::editor

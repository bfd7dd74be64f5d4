// SPDX-License-Identifier: Apache-2.0
#include "plugin_panels.hpp"

#include "base/file.hpp"
#include "base/json.hpp"
#include "document/actions.hpp"
#include "param_widget.hpp"
#include "plugin_actions.hpp"
#include "plugin_ui.hpp"
#include "state.hpp"
#include "widgets.hpp"

#include <imgui.h>
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <utility>

namespace restage::editor {

namespace {

std::filesystem::path file_of(const PanelUi& e) { return e.options().config_dir / "plugin_panels.json"; }

// {"scatter": {"seed": [3], "align": "up"}}: numbers as lists, words as text.
void read_values(PanelUi& e) {
    PluginState& state = e.panel_state->plugins;
    if (std::exchange(state.panels_read, true) || e.options().config_dir.empty()) return;
    const auto text = read_file(file_of(e));
    const auto json = text ? parse_json<nlohmann::json>(*text).value_or(nlohmann::json()) : nlohmann::json();
    if (!json.is_object()) return;
    for (const auto& [panel, values] : json.items()) {
        if (!values.is_object()) continue;
        for (const auto& [id, given] : values.items()) {
            scene::Value v; // untyped: the panel converts it according to its table
            if (given.is_string())
                v.text = given.get<std::string>();
            else if (given.is_array())
                for (std::size_t i = 0; i < std::min<std::size_t>(given.size(), 4); ++i)
                    if (given[i].is_number()) v.v[i] = given[i].get<float>();
            state.remembered[panel].set(id, std::move(v));
        }
    }
}

void write_values(PanelUi& e) {
    if (e.options().config_dir.empty()) return;
    nlohmann::json json = nlohmann::json::object();
    for (const auto& [panel, values] : e.panel_state->plugins.remembered)
        for (const auto& [id, v] : values.entries())
            json[panel][id] = v.text.empty() ? nlohmann::json(v.v) : nlohmann::json(v.text);
    // Failing to store the values is not worth a message.
    (void)write_file_atomic(file_of(e), json.dump(1) + "\n");
}

// Stored values, converted to the types of the table's lines; values that are no longer valid are omitted.
scene::ParamSet typed(model::ParamTable table, const scene::ParamSet& remembered) {
    scene::ParamSet values;
    for (const model::Param& line : table) {
        const scene::Value* set = remembered.find(line.id);
        if (!set) continue;
        scene::Value v{.type = line.type};
        if (v.has_text())
            v.text = set->text;
        else if (v.is_whole())
            v.i = static_cast<int>(std::clamp(double(set->v[0]), -2147483648.0, 2147483647.0));
        else
            v.v = set->v;
        if (misfit(line, v).empty()) values.set(line.id, std::move(v));
    }
    return values;
}

scene::ParamSet untyped(const scene::ParamSet& values) {
    scene::ParamSet result;
    for (const auto& [id, value] : values.entries()) {
        scene::Value v{.text = value.text};
        v.v = value.is_whole() ? std::array{static_cast<float>(value.i), 0.f, 0.f, 0.f} : value.v;
        result.set(id, std::move(v));
    }
    return result;
}

bool set_aside(const PluginState& state, const plugin::PanelEntry& panel) {
    const auto found = state.broken.find(panel.table->id);
    return found != state.broken.end() && !found->second.owner_before(panel.library) &&
           !panel.library.owner_before(found->second);
}

// The panel's values that the action has as well.
bool run(SelectContext& e, const plugin::PanelEntry& panel, const std::string& id, const scene::ParamSet& values) {
    const auto action = document::find_action(e.registry(), id);
    if (!action || action->plugin->manifest.id != panel.plugin->manifest.id) {
        e.notices.add(LogLevel::error,
                      panel.plugin->name() + ": its panel runs \"" + id + "\", which is not one of its actions");
        return false;
    }
    if (!why_not_now(e, *action->table).empty()) return false;
    e.later([&e, action = *action, its = fitting(action->table->params, values)] { start_action(e, action, its); });
    return true;
}

} // namespace

std::string panel_title(const model::Panel& panel) { return panel.label + "###plugin." + panel.id; }

void draw_panel(SelectContext& e, const plugin::PanelEntry& panel) {
    read_values(e);
    PluginState& state = e.panel_state->plugins;
    const model::Panel& table = *panel.table;
    if (set_aside(state, panel)) {
        error_note((panel.plugin->name() +
                    " failed while it drew this panel, which is disabled until the plugin is rebuilt. "
                    "The error is in the log.")
                       .c_str());
        e.mark("panel." + table.id + ".broken");
        if (ImGui::Button("Try again")) state.broken.erase(table.id);
        e.mark("panel." + table.id + ".again");
        return;
    }
    const auto [found, fresh] = state.panels.try_emplace(table.id);
    scene::ParamSet& values = found->second;
    if (fresh) values = typed(table.params, state.remembered[table.id]);
    const scene::ParamSet before = values;
    for (const auto& [id, value] : before.entries()) // may have other values of an earlier version of the plugin
        if (const model::Param* line = table.find(id); !line || !misfit(*line, value).empty()) values.remove(id);
    const std::string mark = "panel." + table.id;
    const scene::ParamSet shown = values; // during the plugin's draw()
    const auto drawn = draw_plugin_panel(
        panel, {.editor = e,
                .table = table.params,
                .values = shown,
                .mark = mark,
                .who = panel.plugin->name() + ": its panel",
                .blame = panel.plugin->blame("while it drew its panel"),
                .row =
                    [&](const model::Param& line) {
                        const scene::Value* set = shown.find(line.id);
                        const ParamAsk ask = param_widget(e, line, set ? *set : scene::default_value(line),
                                                          set != nullptr, mark + "." + line.id);
                        if (ask.reset) values.remove(line.id);
                        if (ask.value) values.set(line.id, *ask.value);
                    },
                .change = [&](const model::Param& line, scene::Value v) { values.set(line.id, std::move(v)); },
                .set =
                    [&](const std::string&, std::vector<std::pair<std::string, scene::Value>> several) {
                        for (auto& [id, v] : several)
                            values.set(id, std::move(v));
                    },
                .run = [&](const std::string& action) { return run(e, panel, action, values); }});
    if (!drawn) { // values that it has set meanwhile are discarded
        values = shown;
        state.broken[table.id] = panel.library;
        e.notices.add(LogLevel::error, table.label + ": " + drawn.error().message);
        return;
    }
    if (scene::ParamSet now = untyped(values); !ImGui::IsAnyItemActive() && now != state.remembered[table.id]) {
        state.remembered[table.id] = std::move(now);
        write_values(e);
    }
}

} // namespace restage::editor

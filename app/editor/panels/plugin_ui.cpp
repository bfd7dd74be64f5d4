// SPDX-License-Identifier: Apache-2.0
#include "panels/plugin_ui.hpp"

#include "panels/state.hpp"
#include "param_widget.hpp"
#include "plugin/panel.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <cmath>

namespace restage::editor {

namespace {

const char* or_empty(const char* text) { return text ? text : ""; }

class HostWidgets final : public plugin::PanelWidgets {
  public:
    explicit HostWidgets(const PluginUi& what) : ui(what) {}

    const PluginUi& ui;
    std::set<std::string> shown;
    int open_groups = 0;
    int widgets = 0; // so far: identifies those without a parameter
    std::string held; // of the last get()

    SelectContext& editor() const { return ui.editor; }
    const model::Param* line(const char* id) const { return id ? model::find_param(ui.table, id) : nullptr; }
    // Records that the parameter is shown; null, and a log line, if none has this id and one of these types.
    const model::Param* claim(const char* id, std::initializer_list<model::ParamType> types) {
        const model::Param* found = line(id);
        if (found && (types.size() == 0 || std::find(types.begin(), types.end(), found->type) != types.end())) {
            shown.insert(id);
            return found;
        }
        const std::string what =
            fmt::format("{} shows \"{}\", which is not such a parameter", ui.who, id ? id : "NULL");
        if (editor().panel_state->said.insert(what).second) editor().log().warning(what);
        return nullptr;
    }
    scene::Value value(const model::Param& p) const {
        const scene::Value* set = ui.values.find(p.id);
        return set && set->type == p.type ? *set : scene::default_value(p);
    }
    std::string next_mark(const char* what) { return ui.mark + ".ui." + what + "." + std::to_string(widgets++); }
    void param(const char* id) override {
        if (const model::Param* p = claim(id, {})) ui.row(*p);
    }

    void hide(const char* id) override { claim(id, {}); }

    void slider(const char* id, const char* label, float min, float max, bool log_scale) override {
        const model::Param* p = claim(id, {model::ParamType::number, model::ParamType::integer});
        if (!p || !(min < max)) return;
        scene::Value v = value(*p);
        ImGui::PushID(id);
        form_row(label && *label ? label : p->label.c_str(), p->tooltip.c_str());
        ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp;
        if (log_scale && min > 0) flags |= ImGuiSliderFlags_Logarithmic;
        bool changed = false;
        if (p->type == model::ParamType::integer)
            changed = ImGui::SliderInt("##value", &v.i, std::max(int(min), p->int_min), std::min(int(max), p->int_max),
                                       "%d", flags);
        else
            changed =
                ImGui::SliderFloat("##value", v.v.data(), std::max(min, p->min), std::min(max, p->max), "%.4g", flags);
        tip(p->tooltip.c_str());
        editor().mark(ui.mark + "." + id);
        if (changed) ui.change(*p, v);
        ImGui::PopID();
    }

    void color(const char* id, const char* label) override {
        const model::Param* p = claim(id, {model::ParamType::color});
        if (!p) return;
        scene::Value v = value(*p);
        ImGui::PushID(id);
        form_row(label && *label ? label : p->label.c_str(), p->tooltip.c_str());
        if (color_field("##value", v.v.data(), p->max > 1)) ui.change(*p, v);
        tip(p->tooltip.c_str());
        editor().mark(ui.mark + "." + id);
        ImGui::PopID();
    }

    void texture(const char* id, const char* label) override {
        const model::Param* p =
            claim(id, {model::ParamType::number, model::ParamType::color, model::ParamType::texture});
        if (!p) return;
        model::Param slot = *p; // shown as a slot for a texture only
        slot.type = model::ParamType::texture;
        if (label && *label) slot.label = label;
        ui.row(slot.type == p->type || p->texturable ? slot : *p);
    }

    int combo(const char* label, const char* const* choices, std::uint32_t count, int current) override {
        const std::string mark = next_mark("combo");
        ImGui::PushID(mark.c_str());
        form_row(or_empty(label));
        const bool known = current >= 0 && std::uint32_t(current) < count;
        int chosen = -1;
        if (ImGui::BeginCombo("##value", known ? or_empty(choices[current]) : "Custom", ImGuiComboFlags_HeightLarge)) {
            for (std::uint32_t i = 0; i < count; ++i) {
                if (ImGui::Selectable(or_empty(choices[i]), int(i) == current)) chosen = int(i);
                editor().mark(mark + "." + or_empty(choices[i]));
            }
            ImGui::EndCombo();
        }
        editor().mark(mark);
        ImGui::PopID();
        return chosen;
    }

    bool button(const char* label, const char* tooltip) override {
        const std::string mark = next_mark("button");
        ImGui::PushID(mark.c_str());
        const bool pressed = ImGui::Button(or_empty(label));
        if (tooltip && *tooltip) tip(tooltip);
        editor().mark(mark);
        ImGui::PopID();
        return pressed;
    }

    void text(const char* line) override { ImGui::TextWrapped("%s", or_empty(line)); }

    bool begin_group(const char* label) override {
        const std::string mark = next_mark("group");
        const bool open = ImGui::TreeNodeEx(mark.c_str(), ImGuiTreeNodeFlags_SpanAvailWidth, "%s", or_empty(label));
        editor().mark(mark);
        open_groups += open;
        return open;
    }
    void end_group() override {
        if (open_groups == 0) return;
        --open_groups;
        ImGui::TreePop();
    }

// A frame with a label on top, as wide as the panel. Returns its corners.
    std::pair<ImVec2, ImVec2> chart(const char* label, float lines, const std::string& mark) {
        if (label && *label) ImGui::TextDisabled("%s", label);
        const ImVec2 a = ImGui::GetCursorScreenPos();
        const ImVec2 size{std::max(ImGui::GetContentRegionAvail().x, 40.f), lines * ImGui::GetTextLineHeight()};
        ImGui::InvisibleButton(mark.c_str(), size);
        editor().mark(mark);
        ImGui::GetWindowDrawList()->AddRectFilled(a, {a.x + size.x, a.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg),
                                                  ImGui::GetStyle().FrameRounding);
        return {a, {a.x + size.x, a.y + size.y}};
    }

    void plot(const char* label, const float* values, std::uint32_t count, std::uint32_t channels, float x_min,
              float x_max, float y_min, float y_max) override {
        if (!values || count < 2 || count > 4096 || (channels != 1 && channels != 3) || !(y_min < y_max)) return;
        const auto [a, b] = chart(label, 6, next_mark("plot"));
        const ImU32 colors[] = {channels == 1 ? ImGui::GetColorU32(ImGuiCol_PlotLines) : IM_COL32(225, 70, 60, 255),
                                IM_COL32(70, 190, 80, 255), IM_COL32(80, 120, 235, 255)};
        const float thickness = 1.5f * ImGui::GetStyle().FontScaleMain;
        std::vector<ImVec2> points(count);
        for (std::uint32_t k = 0; k < channels; ++k) {
            for (std::uint32_t i = 0; i < count; ++i) {
                const float v = values[k * count + i];
                const float y = std::clamp((std::isfinite(v) ? v - y_min : 0.f) / (y_max - y_min), 0.f, 1.f);
                points[i] = {a.x + (b.x - a.x) * float(i) / float(count - 1), b.y - (b.y - a.y) * y};
            }
            ImGui::GetWindowDrawList()->AddPolyline(points.data(), int(count), colors[k], thickness);
        }
        if (!ImGui::IsItemHovered()) return;
        const float t = std::clamp((ImGui::GetMousePos().x - a.x) / (b.x - a.x), 0.f, 1.f);
        const auto at = std::min(std::uint32_t(std::lround(t * float(count - 1))), count - 1);
        std::string said = fmt::format("{:.4g}:", x_min + (x_max - x_min) * float(at) / float(count - 1));
        for (std::uint32_t k = 0; k < channels; ++k)
            said += fmt::format(" {:.4g}", values[k * count + at]);
        ImGui::SetTooltip("%s", said.c_str());
    }

    void curve(const char* label, const char* const* ids, std::uint32_t count) override {
        if (!ids || count < 2 || count > 64) return;
        std::vector<const model::Param*> lines;
        for (std::uint32_t i = 0; i < count; ++i) {
            lines.push_back(claim(ids[i], {model::ParamType::number}));
            if (!lines.back() || !(lines.back()->min < lines.back()->max)) return;
        }
        const auto [a, b] = chart(label, 7, next_mark("curve"));
        const float width = b.x - a.x, height = b.y - a.y, radius = 4 * ImGui::GetStyle().FontScaleMain;
        std::vector<ImVec2> points;
        for (std::uint32_t i = 0; i < count; ++i) {
            const float y = (value(*lines[i]).v[0] - lines[i]->min) / (lines[i]->max - lines[i]->min);
            points.push_back({a.x + radius + (width - 2 * radius) * float(i) / float(count - 1),
                              b.y - radius - (height - 2 * radius) * std::clamp(y, 0.f, 1.f)});
        }
        ImGui::GetWindowDrawList()->AddPolyline(points.data(), int(count), ImGui::GetColorU32(ImGuiCol_PlotLines),
                                                1.5f * ImGui::GetStyle().FontScaleMain);
        for (const ImVec2& p : points)
            ImGui::GetWindowDrawList()->AddCircleFilled(p, radius, ImGui::GetColorU32(ImGuiCol_SliderGrab));
        if (!ImGui::IsItemActive()) return;
    // The point nearest to where the drag began follows the mouse.
        const float begun = (ImGui::GetIO().MouseClickedPos[0].x - a.x - radius) / (width - 2 * radius);
        const auto i = std::min(std::uint32_t(std::lround(std::clamp(begun, 0.f, 1.f) * float(count - 1))), count - 1);
        const float y = std::clamp((b.y - radius - ImGui::GetMousePos().y) / (height - 2 * radius), 0.f, 1.f);
        scene::Value v = value(*lines[i]);
        const float before = v.v[0];
        v.v[0] = lines[i]->min + y * (lines[i]->max - lines[i]->min);
        if (v.v[0] != before) ui.change(*lines[i], v);
    }

    void image(const char* label, const float* rgb, std::uint32_t width, std::uint32_t height) override {
        if (!rgb || width == 0 || height == 0 || width > 96 || height > 96) return; // drawn as rectangles
        const auto [a, b] = chart(label, 6, next_mark("image"));
        const float pixel = std::min((b.x - a.x) / float(width), (b.y - a.y) / float(height));
        for (std::uint32_t y = 0; y < height; ++y)
            for (std::uint32_t x = 0; x < width; ++x) {
                const float* p = rgb + 3 * (std::size_t(y) * width + x);
                const auto seen = [](float v) { return std::pow(std::clamp(v, 0.f, 1.f), 1 / 2.2f); };
                const ImVec2 at{a.x + pixel * float(x), a.y + pixel * float(y)};
                ImGui::GetWindowDrawList()->AddRectFilled(
                    at, {at.x + pixel, at.y + pixel},
                    ImGui::ColorConvertFloat4ToU32({seen(p[0]), seen(p[1]), seen(p[2]), 1}));
            }
    }

    std::optional<plugin::PluginValue> get(const char* id) override {
        const model::Param* p = line(id);
        if (!p) return std::nullopt;
        const scene::Value v = value(*p);
        held = v.text;
        return plugin::PluginValue{.id = p->id.c_str(),
                                   .type = p->type,
                                   .ref = v.texture ? v.texture.value : v.material.value,
                                   .i = v.i,
                                   .v = v.v,
                                   .text = v.has_text() ? held.c_str() : nullptr};
    }

    void set(const char* label, std::span<const plugin::PluginValue> values) override {
        std::vector<std::pair<std::string, scene::Value>> wanted;
        for (const plugin::PluginValue& in : values) {
            const model::Param* p = line(in.id);
            const bool plain =
                in.type && *in.type != model::ParamType::material && *in.type != model::ParamType::texture;
            bool fits = p && p->type == in.type && plain;
            scene::Value v;
            if (fits) {
                v.type = p->type;
                if (v.is_whole()) v.i = in.i;
                for (std::size_t k = 0; k < (p->ranged() && !v.is_whole() ? std::size_t(p->components()) : 0); ++k)
                    v.v[k] = in.v[k];
                if (v.has_text()) v.text = or_empty(in.text);
                fits = scene::misfit(*p, v).empty();
            }
            if (fits)
                wanted.emplace_back(in.id, std::move(v));
            else
                editor().log().warning(fmt::format("{} sets \"{}\" to an invalid value", ui.who, or_empty(in.id)));
        }
        if (!wanted.empty()) ui.set(or_empty(label), std::move(wanted));
    }

    bool run(const char* action) override { return ui.run && ui.run(or_empty(action)); }
    std::uint32_t selected() override {
        return ui.run ? static_cast<std::uint32_t>(editor().selection.instances().size()) : 0;
    }
};

template <class F>
std::set<std::string> show(const PluginUi& ui, F&& draw) {
    HostWidgets widgets(ui);
    ImGui::PushID("plugin");
    {
        const CrashNote note(ui.blame);
        draw(widgets);
    }
    while (widgets.open_groups > 0) // a plugin that forgot end_group
        widgets.end_group();
    ImGui::PopID();
    return std::move(widgets.shown);
}

} // namespace

std::set<std::string> draw_plugin_inspector(const plugin::Inspector& inspector, const PluginUi& ui) {
    return show(ui, [&](HostWidgets& widgets) { inspector.draw(widgets); });
}

Result<> draw_plugin_panel(const plugin::PanelEntry& panel, const PluginUi& ui) {
    Result<> drawn;
    show(ui, [&](HostWidgets& widgets) { drawn = plugin::draw_panel(panel, widgets); });
    return drawn;
}

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
#include "panels/plugin_ui.hpp"

#include "panels/state.hpp"
#include "param_widget.hpp"
#include "scene/edits.hpp"
#include "theme.hpp"
#include "widgets.hpp"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <cmath>

namespace restage::editor {

namespace {

struct Context {
    const PluginUi& ui;
    std::set<std::string> shown;
    int open_groups = 0;
    int widgets = 0; // so far: a name for those without a parameter
    std::string text; // of the last get()

    PanelContext& editor() const { return ui.editor; }
    const RestageParam* line(const char* id) const {
        const RestageMaterial1& table = *ui.plugin.table;
        for (std::uint32_t i = 0; id && i < table.param_count; ++i)
            if (std::string_view(table.params[i].id) == id) return &table.params[i];
        return nullptr;
    }
    // Notes that the parameter is shown; null, and a line in the log, when there is none of the kinds.
    const RestageParam* claim(const char* id, std::initializer_list<std::uint32_t> types) {
        const RestageParam* found = line(id);
        if (found && (types.size() == 0 || std::find(types.begin(), types.end(), found->type) != types.end())) {
            shown.insert(id);
            return found;
        }
        const std::string what = fmt::format("{}: its inspector shows \"{}\", which is no such parameter",
                                             ui.plugin.plugin->name(), id ? id : "NULL");
        if (editor().panel_state->said.insert(what).second) editor().log().warning(what);
        return nullptr;
    }
    scene::Value value(const RestageParam& p) const {
        const scene::Value* set = ui.material.params.find(p.id);
        return set && set->type == static_cast<RestageType>(p.type) ? *set : scene::default_value(p);
    }
    void ask(const RestageParam& p, scene::Value v) const {
        editor().edit([id = ui.id, param = std::string(p.id),
                       v = std::move(v)](const scene::Scene& s) { return scene::set_param(s, id, param, v); },
                      fmt::format("material.{}.{}", ui.id.value, p.id));
    }
    std::string mark(const char* what) { return "material.ui." + std::string(what) + "." + std::to_string(widgets++); }
};

Context& of(void* ctx) { return *static_cast<Context*>(ctx); }
const char* or_empty(const char* text) { return text ? text : ""; }

void param(void* ctx, const char* id) {
    Context& c = of(ctx);
    if (const RestageParam* p = c.claim(id, {})) c.ui.row(*p);
}

void hide(void* ctx, const char* id) { of(ctx).claim(id, {}); }

void slider(void* ctx, const char* id, const char* label, float min, float max, int log_scale) {
    Context& c = of(ctx);
    const RestageParam* p = c.claim(id, {RESTAGE_FLOAT, RESTAGE_INT});
    if (!p || !(min < max)) return;
    scene::Value v = c.value(*p);
    ImGui::PushID(id);
    form_row(label && *label ? label : p->label, p->tooltip);
    ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp;
    if (log_scale && min > 0) flags |= ImGuiSliderFlags_Logarithmic;
    const float lower = std::max(min, p->min), upper = std::min(max, p->max);
    bool changed = false;
    if (p->type == RESTAGE_INT) {
        int i = int(v.v[0]);
        changed = ImGui::SliderInt("##value", &i, int(lower), int(upper), "%d", flags);
        v.v[0] = float(i);
    } else {
        changed = ImGui::SliderFloat("##value", v.v.data(), lower, upper, "%.4g", flags);
    }
    tip(p->tooltip);
    c.editor().mark(std::string("material.") + id);
    if (changed) c.ask(*p, v);
    ImGui::PopID();
}

void color(void* ctx, const char* id, const char* label) {
    Context& c = of(ctx);
    const RestageParam* p = c.claim(id, {RESTAGE_COLOR});
    if (!p) return;
    scene::Value v = c.value(*p);
    ImGui::PushID(id);
    form_row(label && *label ? label : p->label, p->tooltip);
    if (color_field("##value", v.v.data(), p->max > 1)) c.ask(*p, v);
    tip(p->tooltip);
    c.editor().mark(std::string("material.") + id);
    ImGui::PopID();
}

void texture(void* ctx, const char* id, const char* label) {
    Context& c = of(ctx);
    const RestageParam* p = c.claim(id, {RESTAGE_FLOAT, RESTAGE_COLOR, RESTAGE_TEXTURE});
    if (!p) return;
    RestageParam slot = *p; // shown as a slot that only a texture fills
    slot.type = RESTAGE_TEXTURE;
    if (label && *label) slot.label = label;
    c.ui.row(slot.type == p->type || (p->flags & RESTAGE_PARAM_TEXTURABLE) ? slot : *p);
}

int combo(void* ctx, const char* label, const char* const* choices, std::uint32_t count, int current) {
    Context& c = of(ctx);
    const std::string mark = c.mark("combo");
    ImGui::PushID(mark.c_str());
    form_row(or_empty(label));
    const bool known = current >= 0 && std::uint32_t(current) < count;
    int chosen = -1;
    if (ImGui::BeginCombo("##value", known ? or_empty(choices[current]) : "Custom", ImGuiComboFlags_HeightLarge)) {
        for (std::uint32_t i = 0; i < count; ++i) {
            if (ImGui::Selectable(or_empty(choices[i]), int(i) == current)) chosen = int(i);
            c.editor().mark(mark + "." + or_empty(choices[i]));
        }
        ImGui::EndCombo();
    }
    c.editor().mark(mark);
    ImGui::PopID();
    return chosen;
}

int button(void* ctx, const char* label, const char* tooltip) {
    Context& c = of(ctx);
    const std::string mark = c.mark("button");
    ImGui::PushID(mark.c_str());
    const bool pressed = ImGui::Button(or_empty(label));
    if (tooltip && *tooltip) tip(tooltip);
    c.editor().mark(mark);
    ImGui::PopID();
    return pressed;
}

void text(void*, const char* line) { ImGui::TextWrapped("%s", or_empty(line)); }

int begin_group(void* ctx, const char* label) {
    Context& c = of(ctx);
    const std::string mark = c.mark("group");
    const bool open = ImGui::TreeNodeEx(mark.c_str(), ImGuiTreeNodeFlags_SpanAvailWidth, "%s", or_empty(label));
    c.editor().mark(mark);
    c.open_groups += open;
    return open;
}
void end_group(void* ctx) {
    Context& c = of(ctx);
    if (c.open_groups == 0) return;
    --c.open_groups;
    ImGui::TreePop();
}

// A frame with a label on top, as wide as the panel; returns its corners.
std::pair<ImVec2, ImVec2> chart(Context& c, const char* label, float lines, const std::string& mark) {
    if (label && *label) ImGui::TextDisabled("%s", label);
    const ImVec2 a = ImGui::GetCursorScreenPos();
    const ImVec2 size{std::max(ImGui::GetContentRegionAvail().x, 40.f), lines * ImGui::GetTextLineHeight()};
    ImGui::InvisibleButton(mark.c_str(), size);
    c.editor().mark(mark);
    ImGui::GetWindowDrawList()->AddRectFilled(a, {a.x + size.x, a.y + size.y}, ImGui::GetColorU32(ImGuiCol_FrameBg),
                                              ImGui::GetStyle().FrameRounding);
    return {a, {a.x + size.x, a.y + size.y}};
}

void plot(void* ctx, const char* label, const float* values, std::uint32_t count, std::uint32_t channels, float x_min,
          float x_max, float y_min, float y_max) {
    Context& c = of(ctx);
    if (!values || count < 2 || count > 4096 || (channels != 1 && channels != 3) || !(y_min < y_max)) return;
    const auto [a, b] = chart(c, label, 6, c.mark("plot"));
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

void curve(void* ctx, const char* label, const char* const* ids, std::uint32_t count) {
    Context& c = of(ctx);
    if (!ids || count < 2 || count > 64) return;
    std::vector<const RestageParam*> lines;
    for (std::uint32_t i = 0; i < count; ++i) {
        lines.push_back(c.claim(ids[i], {RESTAGE_FLOAT}));
        if (!lines.back() || !(lines.back()->min < lines.back()->max)) return;
    }
    const auto [a, b] = chart(c, label, 7, c.mark("curve"));
    const float width = b.x - a.x, height = b.y - a.y, radius = 4 * ImGui::GetStyle().FontScaleMain;
    std::vector<ImVec2> points;
    for (std::uint32_t i = 0; i < count; ++i) {
        const float y = (c.value(*lines[i]).v[0] - lines[i]->min) / (lines[i]->max - lines[i]->min);
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
    scene::Value v = c.value(*lines[i]);
    const float before = v.v[0];
    v.v[0] = lines[i]->min + y * (lines[i]->max - lines[i]->min);
    if (v.v[0] != before) c.ask(*lines[i], v);
}

void image(void* ctx, const char* label, const float* rgb, std::uint32_t width, std::uint32_t height) {
    Context& c = of(ctx);
    if (!rgb || width == 0 || height == 0 || width > 96 || height > 96) return; // drawn as rectangles
    const auto [a, b] = chart(c, label, 6, c.mark("image"));
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

int get(void* ctx, const char* id, RestageValue* out) {
    Context& c = of(ctx);
    const RestageParam* p = c.line(id);
    if (!p || !out) return 0;
    const scene::Value v = c.value(*p);
    c.text = v.text;
    *out = {.id = p->id,
            .type = p->type,
            .ref = v.texture ? v.texture.value : v.material.value,
            .v = {v.v[0], v.v[1], v.v[2], v.v[3]},
            .text = p->type == RESTAGE_ENUM || p->type == RESTAGE_TEXT || p->type == RESTAGE_TABLE ? c.text.c_str()
                                                                                                   : nullptr};
    return 1;
}

void set(void* ctx, const char* label, const RestageValue* values, std::uint32_t count) {
    Context& c = of(ctx);
    std::vector<std::pair<std::string, scene::Value>> wanted;
    for (std::uint32_t i = 0; values && i < count; ++i) {
        const RestageParam* p = c.line(values[i].id);
        const std::uint32_t type = values[i].type;
        const bool plain = type == RESTAGE_FLOAT || type == RESTAGE_COLOR || type == RESTAGE_INT ||
                           type == RESTAGE_BOOL || type == RESTAGE_ENUM || type == RESTAGE_TEXT ||
                           type == RESTAGE_TABLE;
        scene::Value v{.type = static_cast<RestageType>(type)};
        bool fits = p && p->type == type && plain;
        for (int k = 0; fits && k < (type == RESTAGE_COLOR ? 3 : 1); ++k) {
            v.v[std::size_t(k)] = values[i].v[k];
            const bool ranged = type == RESTAGE_FLOAT || type == RESTAGE_COLOR || type == RESTAGE_INT;
            fits = std::isfinite(values[i].v[k]) && (!ranged || (values[i].v[k] >= p->min && values[i].v[k] <= p->max));
        }
        if (fits && (type == RESTAGE_ENUM || type == RESTAGE_TEXT || type == RESTAGE_TABLE)) {
            v.text = or_empty(values[i].text);
            v.v = {};
            fits = type != RESTAGE_ENUM || scene::choice_index(p->choices, v.text).has_value();
        }
        if (fits)
            wanted.emplace_back(values[i].id, std::move(v));
        else
            c.editor().log().warning(fmt::format("{}: its inspector sets \"{}\" to what it cannot be",
                                                 c.ui.plugin.plugin->name(), or_empty(values[i].id)));
    }
    if (wanted.empty()) return;
    c.editor().edit([id = c.ui.id, said = std::string(or_empty(label)), wanted](const scene::Scene& s) {
        return scene::set_params(s, id, wanted, said);
    });
}

constexpr RestageUi1 widgets{.size = sizeof(RestageUi1),
                             .param = param,
                             .hide = hide,
                             .slider = slider,
                             .color = color,
                             .texture = texture,
                             .combo = combo,
                             .button = button,
                             .text = text,
                             .begin_group = begin_group,
                             .end_group = end_group,
                             .plot = plot,
                             .curve = curve,
                             .image = image,
                             .get = get,
                             .set = set};

} // namespace

std::set<std::string> draw_plugin_inspector(const RestageInspector1& inspector, const PluginUi& ui) {
    Context context{.ui = ui, .shown = {}, .text = {}};
    ImGui::PushID("plugin");
    {
        const CrashNote note(ui.plugin.plugin->blame("while it drew its part of the inspector"));
        inspector.draw(&widgets, &context);
    }
    while (context.open_groups > 0) // a plugin that forgot end_group
        end_group(&context);
    ImGui::PopID();
    return std::move(context.shown);
}

} // namespace restage::editor

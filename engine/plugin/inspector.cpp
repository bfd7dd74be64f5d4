// SPDX-License-Identifier: Apache-2.0
#include "plugin/inspector.hpp"

#include "plugin/abi.hpp"
#include "plugin/adapters.hpp"
#include "plugin/panel.hpp"

#include <restage/action.h>
#include <restage/inspector.h>
#include <algorithm>
#include <exception>
#include <string>
#include <vector>

namespace restage::plugin {

namespace {

Widgets& of(void* ctx) { return *static_cast<Widgets*>(ctx); }

int get(void* ctx, const char* id, RestageValue* out) {
    const auto value = of(ctx).get(id);
    if (!value || !out) return 0;
    RestageValue given{};
    given.id = value->id;
    given.type = value->type ? abi_type(*value->type) : 0;
    given.ref = value->ref;
    given.i = value->i;
    std::copy(value->v.begin(), value->v.end(), given.v);
    given.text = value->text;
    give(out, given);
    return 1;
}

void set(void* ctx, const char* label, const RestageValue* values, std::uint32_t count) {
    std::vector<PluginValue> list;
    for (std::uint32_t i = 0; values && i < count; ++i) {
        const RestageValue in = element(values, i);
        PluginValue& out = list.emplace_back(
            PluginValue{.id = in.id, .type = model_type(in.type), .ref = in.ref, .i = in.i, .v = {}, .text = in.text});
        std::copy_n(in.v, 4, out.v.begin());
    }
    of(ctx).set(label, list);
}

constexpr RestageUi1 table{
    .size = sizeof(RestageUi1),
    .param = [](void* c, const char* id) { of(c).param(id); },
    .hide = [](void* c, const char* id) { of(c).hide(id); },
    .slider = [](void* c, const char* id, const char* label, float min, float max,
                 int log_scale) { of(c).slider(id, label, min, max, log_scale != 0); },
    .color = [](void* c, const char* id, const char* label) { of(c).color(id, label); },
    .texture = [](void* c, const char* id, const char* label) { of(c).texture(id, label); },
    .combo = [](void* c, const char* label, const char* const* choices, std::uint32_t count,
                int current) { return of(c).combo(label, choices, count, current); },
    .button = [](void* c, const char* label, const char* tooltip) { return int(of(c).button(label, tooltip)); },
    .text = [](void* c, const char* text) { of(c).text(text); },
    .begin_group = [](void* c, const char* label) { return int(of(c).begin_group(label)); },
    .end_group = [](void* c) { of(c).end_group(); },
    .plot = [](void* c, const char* label, const float* values, std::uint32_t count, std::uint32_t channels,
               float x_min, float x_max, float y_min,
               float y_max) { of(c).plot(label, values, count, channels, x_min, x_max, y_min, y_max); },
    .curve = [](void* c, const char* label, const char* const* ids,
                std::uint32_t count) { of(c).curve(label, ids, count); },
    .image = [](void* c, const char* label, const float* rgb, std::uint32_t width,
                std::uint32_t height) { of(c).image(label, rgb, width, height); },
    .get = get,
    .set = set,
    .run =
        [](void* c, const char* action) {
            auto* panel = dynamic_cast<PanelWidgets*>(&of(c));
            return int(panel && panel->run(action));
        },
    .selected =
        [](void* c) {
            auto* panel = dynamic_cast<PanelWidgets*>(&of(c));
            return panel ? panel->selected() : 0u;
        }};

} // namespace

Result<Inspector> Inspector::read(const RestageInspector1& given) {
    if (const auto problem = too_short(given.size, RESTAGE_SIZE_UP_TO(RestageInspector1, draw), RESTAGE_INSPECTOR1);
        !problem.empty())
        return fail(problem);
    Inspector out;
    out.material_type = given.type ? given.type : "";
    if (!given.draw) return fail("the inspector of \"" + out.material_type + "\" lacks draw");
    out.table_ = &given;
    return out;
}

void Inspector::draw(Widgets& widgets) const { table_->draw(&table, &widgets); }

Result<> draw_panel(const PanelEntry& panel, PanelWidgets& widgets) {
    try {
        panel.native->draw(&table, static_cast<Widgets*>(&widgets));
    } catch (const std::exception& e) {
        return fail("draw() threw an exception: " + std::string(e.what()));
    } catch (...) {
        return fail("draw() threw an exception");
    }
    return {};
}

} // namespace restage::plugin

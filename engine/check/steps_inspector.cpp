// SPDX-License-Identifier: Apache-2.0
// Native code of materials that runs in the editor: what draws a part of the inspector, against widgets that answer
// anything a user might do; and what reads the files of table parameters, with any file.
#include "check/steps.hpp"
#include "check/workplace.hpp"

#include "base/file.hpp"
#include "plugin/table_reader.hpp"
#include "render/material_types.hpp"

#include <fmt/format.h>
#include <restage/inspector.h>
#include <algorithm>
#include <cmath>
#include <cstring>

namespace restage::check {

namespace fs = std::filesystem;
using scene::ParamSet;
using scene::Value;

namespace {

// The editor's widgets, without a window. What breaks the contract is noted; the first is shown.
struct FakeUi {
    const RestageMaterial1& table;
    Engine& random;
    ParamSet values;
    std::string problem = {}, text = {};
    std::vector<bool> groups = {}; // those that are open
    std::size_t widgets = 0, sets = 0, looked_at = 0;
    double sum = 0; // of all that was shown: memory that is not there is noticed

    void note(std::string what) {
        if (problem.empty()) problem = std::move(what);
    }
    const RestageParam* line(const char* id, const char* widget) {
        ++widgets;
        if (!id) return note(fmt::format("{}() is given no id", widget)), nullptr;
        for (std::uint32_t i = 0; i < table.param_count; ++i)
            if (std::strcmp(table.params[i].id, id) == 0) return &table.params[i];
        note(fmt::format("{}() names \"{}\", which is not in the table", widget, id));
        return nullptr;
    }
    void label(const char* said, const char* widget) {
        ++widgets;
        if (!said) return note(fmt::format("{}() is given no text", widget));
        looked_at += std::strlen(said);
    }
    void numbers(const float* at, std::size_t count, const char* widget) {
        if (!at && count > 0) return note(fmt::format("{}() is given no numbers", widget));
        for (std::size_t i = 0; i < count; ++i) {
            if (!std::isfinite(at[i])) return note(fmt::format("{}() is given {}", widget, at[i]));
            sum += at[i];
        }
        looked_at += count;
    }
    Value value_of(const RestageParam& p) const {
        const Value* set = values.find(p.id);
        return set ? *set : scene::default_value(p);
    }
};

FakeUi& of(void* ctx) { return *static_cast<FakeUi*>(ctx); }

void ui_param(void* ctx, const char* id) { of(ctx).line(id, "param"); }
void ui_hide(void* ctx, const char* id) { of(ctx).line(id, "hide"); }
void ui_slider(void* ctx, const char* id, const char* label, float min, float max, int) {
    of(ctx).line(id, "slider"), of(ctx).label(label, "slider");
    if (!(min <= max)) of(ctx).note(fmt::format("slider() goes from {} to {}", min, max));
}
void ui_color(void* ctx, const char* id, const char* label) {
    of(ctx).line(id, "color"), of(ctx).label(label, "color");
}
void ui_texture(void* ctx, const char* id, const char* label) {
    of(ctx).line(id, "texture"), of(ctx).label(label, "texture");
}
int ui_combo(void* ctx, const char* label, const char* const* choices, std::uint32_t count, int current) {
    FakeUi& ui = of(ctx);
    ui.label(label, "combo");
    for (std::uint32_t i = 0; i < count; ++i)
        ui.label(choices ? choices[i] : nullptr, "combo");
    if (current >= static_cast<int>(count)) ui.note(fmt::format("combo() of {} texts shows number {}", count, current));
    return count > 0 && ui.random() % 3 == 0 ? static_cast<int>(ui.random() % count) : -1;
}
int ui_button(void* ctx, const char* label, const char* tooltip) {
    of(ctx).label(label, "button");
    of(ctx).looked_at += tooltip ? std::strlen(tooltip) : 0;
    return of(ctx).random() % 3 == 0;
}
void ui_text(void* ctx, const char* text) { of(ctx).label(text, "text"); }
int ui_begin_group(void* ctx, const char* label) {
    of(ctx).label(label, "begin_group");
    const bool open = of(ctx).random() % 3 != 0;
    if (open) of(ctx).groups.push_back(true);
    return open;
}
void ui_end_group(void* ctx) {
    if (of(ctx).groups.empty()) return of(ctx).note("end_group() without a group that is open");
    of(ctx).groups.pop_back();
}
void ui_plot(void* ctx, const char* label, const float* values, std::uint32_t count, std::uint32_t channels, float,
             float, float, float) {
    of(ctx).label(label, "plot");
    if (channels != 1 && channels != 3)
        of(ctx).note(fmt::format("plot() of {} channels; 1 and 3 are possible", channels));
    of(ctx).numbers(values, std::size_t{count} * channels, "plot");
}
void ui_curve(void* ctx, const char* label, const char* const* ids, std::uint32_t count) {
    of(ctx).label(label, "curve");
    for (std::uint32_t i = 0; i < count; ++i)
        of(ctx).line(ids ? ids[i] : nullptr, "curve");
}
void ui_image(void* ctx, const char* label, const float* rgb, std::uint32_t width, std::uint32_t height) {
    of(ctx).label(label, "image");
    of(ctx).numbers(rgb, std::size_t{width} * height * 3, "image");
}
int ui_get(void* ctx, const char* id, RestageValue* out) {
    FakeUi& ui = of(ctx);
    const RestageParam* p = ui.line(id, "get");
    if (!p || !out) return 0;
    const Value v = ui.value_of(*p);
    ui.text = v.text;
    const bool texts = p->type == RESTAGE_ENUM || p->type == RESTAGE_TEXT || p->type == RESTAGE_TABLE;
    *out = {.id = p->id,
            .type = p->type,
            .ref = 0,
            .v = {v.v[0], v.v[1], v.v[2], v.v[3]},
            .text = texts ? ui.text.c_str() : nullptr};
    return 1;
}
void ui_set(void* ctx, const char* label, const RestageValue* values, std::uint32_t count) {
    FakeUi& ui = of(ctx);
    ui.label(label, "set");
    for (std::uint32_t i = 0; values && i < count; ++i) {
        const RestageParam* p = ui.line(values[i].id, "set");
        if (!p) continue;
        ++ui.sets;
        const std::string who = fmt::format("set() of \"{}\"", p->id);
        if (p->type != values[i].type) {
            ui.note(who + " has another type than the table");
            continue;
        }
        Value v{.type = static_cast<RestageType>(p->type)};
        const bool ranged = p->type == RESTAGE_FLOAT || p->type == RESTAGE_COLOR || p->type == RESTAGE_INT;
        for (std::size_t k = 0; k < (p->type == RESTAGE_COLOR ? 3u : 1u) && (ranged || p->type == RESTAGE_BOOL); ++k) {
            v.v[k] = values[i].v[k];
            if (!std::isfinite(v.v[k]) || (ranged && !(v.v[k] >= p->min && v.v[k] <= p->max)))
                ui.note(fmt::format("{} to {}, which is out of its range ({} to {})", who, v.v[k], p->min, p->max));
        }
        if (p->type == RESTAGE_ENUM || p->type == RESTAGE_TEXT || p->type == RESTAGE_TABLE) {
            v.text = values[i].text ? values[i].text : "";
            if (p->type == RESTAGE_ENUM && !scene::choice_index(p->choices, v.text))
                ui.note(fmt::format("{} to \"{}\"; there are {}", who, v.text, p->choices));
        }
        if (ui.problem.empty()) ui.values.set(p->id, std::move(v));
    }
}

constexpr RestageUi1 widgets{.size = sizeof(RestageUi1),
                             .param = ui_param,
                             .hide = ui_hide,
                             .slider = ui_slider,
                             .color = ui_color,
                             .texture = ui_texture,
                             .combo = ui_combo,
                             .button = ui_button,
                             .text = ui_text,
                             .begin_group = ui_begin_group,
                             .end_group = ui_end_group,
                             .plot = ui_plot,
                             .curve = ui_curve,
                             .image = ui_image,
                             .get = ui_get,
                             .set = ui_set};

} // namespace

Result<StepResult> check_inspector(Subject& s) {
    const RestageInspector1* inspector = s.registry().find_inspector(s.table().type);
    if (!inspector) return StepResult::skip("it has no part of the inspector of its own");
    Engine e = s.random("inspector");
    std::size_t shown = 0, sets = 0;
    const std::size_t draws = s.size(400, 120);
    FakeUi ui{.table = s.table(), .random = e, .values = {}};
    for (std::size_t i = 0; i < draws; ++i) {
        // What one draw has set, the next one shows; and now and then another material is selected.
        if (i % 8 == 7) ui.values = random_config(s.table(), e);
        s.doing(fmt::format("draw() number {} with {}", i + 1, describe(ui.values)));
        inspector->draw(&widgets, &ui);
        s.alive();
        shown += ui.widgets, sets += ui.sets;
        ui.widgets = ui.sets = 0;
        if (ui.problem.empty() && !ui.groups.empty()) ui.note("draw() returns with a group that is open: end_group()");
        if (!ui.problem.empty())
            return StepResult::failed(
                fmt::format("{}\n  in draw() number {} with {}", ui.problem, i + 1, describe(ui.values)));
    }
    return StepResult::passed({{"draws", double(draws)}, {"widgets", double(shown)}, {"values set", double(sets)}});
}

Result<StepResult> check_tables(Subject& s) {
    std::vector<const RestageParam*> lines;
    for (std::uint32_t i = 0; i < s.table().param_count; ++i)
        if (s.table().params[i].type == RESTAGE_TABLE) lines.push_back(&s.table().params[i]);
    if (lines.empty()) return StepResult::skip("it has no table parameter");
    const auto reader = s.material().source->table_reader();
    if (!reader) return StepResult::failed("it has a table parameter and provides no restage.table/1 that reads it");
    const TemporaryFolder folder;
    Engine e = s.random("tables");
    std::size_t files = 0, taken = 0, defaults = 0;
    for (const RestageParam* p : lines) {
        std::string good;
        if (const std::string file = render::table_path(*p, {}); !file.empty()) {
            s.doing("read() of the default file of \"" + std::string(p->id) + "\"");
            RESTAGE_CHECK(reader->read(p->id, file));
            RESTAGE_TRY(good, read_file(file));
            ++defaults;
        }
        const std::string head = good.substr(0, 64);
        for (std::size_t k = 0; k < s.size(300, 100); ++k) {
            const bool broken = !good.empty() && good.size() <= 4 << 20 && k % 2;
            const std::string bytes = broken ? broken_version(e, good, k / 2) : noise(e, k, k % 3 ? "" : head);
            // Each has a name of its own: what was read is remembered.
            const fs::path file = folder.path / fmt::format("{} {}.{}", p->id, k, reader->extensions()[0]);
            RESTAGE_CHECK(write_file_atomic(file, bytes));
            s.doing(fmt::format("read() of {} for \"{}\", {} bytes",
                                broken ? "a broken version of the default" : "noise", p->id, bytes.size()));
            const auto read = reader->read(p->id, file.string());
            std::error_code ignored;
            fs::remove(file, ignored);
            s.alive();
            ++files, taken += read.has_value();
            if (!read && read.error().message.ends_with("refused it and did not say why"))
                return StepResult::failed(
                    fmt::format("read() of {} bytes returns 0, and error() was not called", bytes.size()));
        }
    }
    return StepResult::passed(
        {{"default files", double(defaults)}, {"broken files and noise", double(files)}, {"taken", double(taken)}});
}

} // namespace restage::check

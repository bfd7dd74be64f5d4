// SPDX-License-Identifier: Apache-2.0
// Native code of materials that runs in the editor: what draws a part of the inspector, against widgets that answer
// anything a user might do; and what reads the files of table parameters, with any file.
#include "check/steps.hpp"
#include "check/workplace.hpp"

#include "base/file.hpp"
#include "plugin/table_reader.hpp"
#include "render/material_types.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <cstring>

namespace restage::check {

namespace fs = std::filesystem;
using scene::ParamSet;
using scene::Value;

namespace {

// The editor's widgets, without a window. What breaks the contract is noted; the first is shown.
struct FakeUi final : plugin::Widgets {
    FakeUi(const model::Material& declared, Engine& engine) : table(declared), random(engine) {}

    const model::Material& table;
    Engine& random;
    ParamSet values;
    std::string problem, held;
    std::vector<bool> groups; // those that are open
    std::size_t widgets = 0, sets = 0, looked_at = 0;
    double sum = 0; // of all that was shown: memory that is not there is noticed

    void note(std::string what) {
        if (problem.empty()) problem = std::move(what);
    }
    const model::Param* line(const char* id, const char* widget) {
        ++widgets;
        if (!id) return note(fmt::format("{}() is given no id", widget)), nullptr;
        if (const model::Param* found = table.find(id)) return found;
        note(fmt::format("{}() names \"{}\", which is not in the table", widget, id));
        return nullptr;
    }
    void said(const char* said_text, const char* widget) {
        ++widgets;
        if (!said_text) return note(fmt::format("{}() is given no text", widget));
        looked_at += std::strlen(said_text);
    }
    void numbers(const float* at, std::size_t count, const char* widget) {
        if (!at && count > 0) return note(fmt::format("{}() is given no numbers", widget));
        for (std::size_t i = 0; i < count; ++i) {
            if (!std::isfinite(at[i])) return note(fmt::format("{}() is given {}", widget, at[i]));
            sum += at[i];
        }
        looked_at += count;
    }
    Value value_of(const model::Param& p) const {
        const Value* set = values.find(p.id);
        return set ? *set : scene::default_value(p);
    }

    void param(const char* id) override { line(id, "param"); }
    void hide(const char* id) override { line(id, "hide"); }
    void slider(const char* id, const char* label, float min, float max, bool) override {
        line(id, "slider"), said(label, "slider");
        if (!(min <= max)) note(fmt::format("slider() goes from {} to {}", min, max));
    }
    void color(const char* id, const char* label) override { line(id, "color"), said(label, "color"); }
    void texture(const char* id, const char* label) override { line(id, "texture"), said(label, "texture"); }
    int combo(const char* label, const char* const* texts, std::uint32_t count, int current) override {
        said(label, "combo");
        for (std::uint32_t i = 0; i < count; ++i)
            said(texts ? texts[i] : nullptr, "combo");
        if (current >= static_cast<int>(count))
            note(fmt::format("combo() of {} texts shows number {}", count, current));
        return count > 0 && random() % 3 == 0 ? static_cast<int>(random() % count) : -1;
    }
    bool button(const char* label, const char* tooltip) override {
        said(label, "button");
        looked_at += tooltip ? std::strlen(tooltip) : 0;
        return random() % 3 == 0;
    }
    void text(const char* line) override { said(line, "text"); }
    bool begin_group(const char* label) override {
        said(label, "begin_group");
        const bool open = random() % 3 != 0;
        if (open) groups.push_back(true);
        return open;
    }
    void end_group() override {
        if (groups.empty()) return note("end_group() without a group that is open");
        groups.pop_back();
    }
    void plot(const char* label, const float* y, std::uint32_t count, std::uint32_t channels, float, float, float,
              float) override {
        said(label, "plot");
        if (channels != 1 && channels != 3) note(fmt::format("plot() of {} channels; 1 and 3 are possible", channels));
        numbers(y, std::size_t{count} * channels, "plot");
    }
    void curve(const char* label, const char* const* ids, std::uint32_t count) override {
        said(label, "curve");
        for (std::uint32_t i = 0; i < count; ++i)
            line(ids ? ids[i] : nullptr, "curve");
    }
    void image(const char* label, const float* rgb, std::uint32_t width, std::uint32_t height) override {
        said(label, "image");
        numbers(rgb, std::size_t{width} * height * 3, "image");
    }
    std::optional<plugin::PluginValue> get(const char* id) override {
        const model::Param* p = line(id, "get");
        if (!p) return std::nullopt;
        const Value v = value_of(*p);
        held = v.text;
        return plugin::PluginValue{.id = p->id.c_str(),
                                   .type = p->type,
                                   .ref = 0,
                                   .i = v.i,
                                   .v = v.v,
                                   .text = v.has_text() ? held.c_str() : nullptr};
    }
    void set(const char* label, std::span<const plugin::PluginValue> given) override {
        said(label, "set");
        for (const plugin::PluginValue& in : given) {
            const model::Param* p = line(in.id, "set");
            if (!p) continue;
            ++sets;
            const std::string who = fmt::format("set() of \"{}\"", p->id);
            if (p->type != in.type) {
                note(who + " has another type than the table");
                continue;
            }
            Value v{.type = p->type};
            if (v.is_whole())
                v.i = in.i;
            else if (p->ranged())
                for (std::size_t k = 0; k < std::size_t(p->components()); ++k)
                    v.v[k] = in.v[k];
            if (v.has_text()) v.text = in.text ? in.text : "";
            if (const std::string why = scene::misfit(*p, v); !why.empty()) note(who + why);
            if (problem.empty()) values.set(p->id, std::move(v));
        }
    }
};

} // namespace

Result<StepResult> check_inspector(Subject& s) {
    const plugin::Inspector* const inspector = s.registry().find_inspector(s.table().type);
    if (!inspector) return StepResult::skip("it has no part of the inspector of its own");
    Engine e = s.random("inspector");
    std::size_t shown = 0, sets = 0;
    const std::size_t draws = s.size(400, 120);
    FakeUi ui(s.table(), e);
    for (std::size_t i = 0; i < draws; ++i) {
        // What one draw has set, the next one shows; and now and then another material is selected.
        if (i % 8 == 7) ui.values = random_config(s.table(), e);
        s.doing(fmt::format("draw() number {} with {}", i + 1, describe(ui.values)));
        inspector->draw(ui);
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
    std::vector<const model::Param*> lines;
    for (const model::Param& line : s.table().params)
        if (line.type == model::ParamType::table) lines.push_back(&line);
    if (lines.empty()) return StepResult::skip("it has no table parameter");
    const auto reader = s.material().source->table_reader();
    if (!reader) return StepResult::failed("it has a table parameter and provides no restage.table/1 that reads it");
    const TemporaryFolder folder;
    Engine e = s.random("tables");
    std::size_t files = 0, taken = 0, defaults = 0;
    for (const model::Param* p : lines) {
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

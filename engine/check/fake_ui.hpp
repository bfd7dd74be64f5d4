// SPDX-License-Identifier: Apache-2.0
// The editor's widgets without a window: they simulate any user input, and record violations of the contract.
#pragma once

#include "check/configs.hpp"
#include "plugin/panel.hpp"

#include <fmt/format.h>
#include <cmath>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

namespace restage::check {

// Only the first violation is shown.
struct FakeUi final : plugin::PanelWidgets {
    FakeUi(model::ParamTable declared, Engine& engine) : table(declared), random(engine) {}

    model::ParamTable table;
    Engine& random;
    scene::ParamSet values;
    std::string problem, held;
    std::vector<bool> groups; // open groups
    std::size_t widgets = 0, sets = 0, looked_at = 0, runs = 0;
    std::uint32_t selection = 0; // selected objects
    std::function<std::string(const std::string&)> runs_action; // of a panel: "" or why it cannot run this action
    double sum = 0; // of everything shown: reads all memory, so that invalid pointers are found

    void note(std::string what) {
        if (problem.empty()) problem = std::move(what);
    }
    const model::Param* line(const char* id, const char* widget) {
        ++widgets;
        if (!id) return note(fmt::format("{}() is called without an id", widget)), nullptr;
        if (const model::Param* found = model::find_param(table, id)) return found;
        note(fmt::format("{}() names \"{}\", which is not in the table", widget, id));
        return nullptr;
    }
    void said(const char* said_text, const char* widget) {
        ++widgets;
        if (!said_text) return note(fmt::format("{}() is called without a text", widget));
        looked_at += std::strlen(said_text);
    }
    void numbers(const float* at, std::size_t count, const char* widget) {
        if (!at && count > 0) return note(fmt::format("{}() is called without numbers", widget));
        for (std::size_t i = 0; i < count; ++i) {
            if (!std::isfinite(at[i])) return note(fmt::format("{}() is given {}", widget, at[i]));
            sum += at[i];
        }
        looked_at += count;
    }
    scene::Value value_of(const model::Param& p) const {
        const scene::Value* set = values.find(p.id);
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
            note(fmt::format("combo() of {} texts has the current index {}", count, current));
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
        if (groups.empty()) return note("end_group() without an open group");
        groups.pop_back();
    }
    void plot(const char* label, const float* y, std::uint32_t count, std::uint32_t channels, float, float, float,
              float) override {
        said(label, "plot");
        if (channels != 1 && channels != 3) note(fmt::format("plot() of {} channels; it must be 1 or 3", channels));
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
        const scene::Value v = value_of(*p);
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
            scene::Value v{.type = p->type};
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

    bool run(const char* action) override {
        said(action, "run");
        if (!action || !runs_action) return false;
        if (const std::string why = runs_action(action); !why.empty()) note(why);
        ++runs;
        return random() % 3 != 0;
    }
    std::uint32_t selected() override { return selection; }
};

} // namespace restage::check

// SPDX-License-Identifier: Apache-2.0
// Actions: on scenes with every kind of thing, with a surface and objects to put on it, and without objects; with
// selections of several sizes and any parameters: identical, valid edits twice, different ones with another seed, which
// undo reverts and redo repeats; cancelled at every call of progress(); a hundred runs. Panels: drawn with widgets that
// simulate any user input.
#include "check/action_scenes.hpp"
#include "check/fake_ui.hpp"
#include "check/steps.hpp"
#include "check/workplace.hpp"

#include "document/actions.hpp"
#include "scene/tables.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <chrono>

namespace restage::check {

using namespace scene;

namespace {

using Ids = std::vector<Id<Instance>>;

// Compares contents: new geometry and pixels are never shared.
bool alike(const Mesh& a, Mesh b) {
    const auto x = a.data, y = b.data;
    b.data = a.data;
    return a == b &&
           (x == y || (x && y && x->positions == y->positions && x->normals == y->normals && x->uvs == y->uvs &&
                       x->uvs2 == y->uvs2 && x->triangles == y->triangles && x->tangents == y->tangents));
}
bool alike(const Image& a, Image b) {
    const auto x = a.data, y = b.data;
    b.data = a.data;
    return a == b && (x == y || (x && y && x->width == y->width && x->height == y->height &&
                                 x->channels == y->channels && x->values == y->values));
}
template <class T>
bool alike(const T& a, const T& b) {
    return a == b;
}
template <class T>
bool alike(const std::optional<T>& a, const std::optional<T>& b) {
    return a.has_value() == b.has_value() && (!a || alike(*a, *b));
}

bool alike(const Edit& a, const Edit& b) {
    return std::ranges::equal(a.changes, b.changes, [](const AnyChange& x, const AnyChange& y) {
        return std::visit(
            [&]<class C>(const C& c) {
                const C* other = std::get_if<C>(&y);
                if (!other || !alike(c.before, other->before) || !alike(c.after, other->after)) return false;
                if constexpr (requires { c.id; }) return c.id == other->id;
                return true;
            },
            x);
    });
}

// All things and singletons are as before; additional empty slots are ignored.
bool same(const Scene& a, const Scene& b) {
    bool equal = true;
    each_kind([&]<class T>(const Kind<T>& kind) {
        const auto &x = a.*kind.table, &y = b.*kind.table;
        equal &= x.live() == y.live();
        x.each([&](Id<T> id, const T& item) { equal &= y.find(id) && *y.find(id) == item; });
    });
    each_single([&](const auto& single) { equal &= (a.*single.one).value == (b.*single.one).value; });
    return equal;
}

std::string attempt(const std::string& scene, std::size_t selected, const ParamSet& values) {
    return fmt::format("{}, {} objects selected, {}", scene, selected, describe(values));
}

// The selections that the action accepts.
std::vector<Ids> selections(const model::Action& action, const ActionScene& of) {
    std::vector<Ids> found = of.selections;
    if (action.needs_selection) std::erase_if(found, [](const Ids& ids) { return ids.empty(); });
    return found;
}

// By convention, the seed of random numbers (docs/plugins.md). Null if there is none, or if it has only one value.
const model::Param* seed_of(const model::Action& action) {
    const model::Param* seed = action.find("seed");
    return seed && seed->type == model::ParamType::integer && seed->int_min < seed->int_max ? seed : nullptr;
}

struct Totals {
    std::size_t runs = 0, changed = 0, refused = 0, most_added = 0, seeds = 0;
};

// "" or the problem with two identical runs, their edit, undo and redo.
std::string judge_run(Subject& s, const Scene& scene, const io::ActionRun& run, Totals& totals) {
    document::Session session(s.registry());
    session.adopt(scene);
    const Scene before = session.scene();
    auto first = io::run_action(before, s.registry(), s.action, run);
    const auto second = io::run_action(before, s.registry(), s.action, run);
    s.alive();
    ++totals.runs;
    if (first.has_value() != second.has_value()) return "of two identical runs one fails and one succeeds";
    if (!first) {
        const std::string& message = first.error().message;
        if (message.find(io::no_reason) != std::string::npos) return "run() returns 0, and error() was not called";
        if (message.find(io::threw) != std::string::npos || message.find(io::unsound) != std::string::npos)
            return message;
        ++totals.refused;
        return "";
    }
    if (!alike(first->edit, second->edit)) return "two identical runs give different edits";
    if (const model::Param* seed = seed_of(*s.action.table);
        seed && !first->edit.changes.empty() && run.values.entries().empty()) {
        io::ActionRun other = run;
        const Value now = default_value(*seed);
        other.values.set(seed->id, Value::integer(now.i < seed->int_max ? now.i + 1 : now.i - 1));
        const auto third = io::run_action(before, s.registry(), s.action, other);
        if (third && alike(first->edit, third->edit)) return "another \"seed\" gives the same edit";
        ++totals.seeds;
    }
    const auto done = document::apply_action(session, std::move(*first));
    if (!done) return done.error().message;
    totals.changed += done->changed;
    const Scene after = session.scene();
    totals.most_added = std::max<std::size_t>(
        totals.most_added, after.instances.live() - std::min(after.instances.live(), before.instances.live()));
    if (done->changed && (session.history().size() != 1 || !session.undo())) return "it is not one undo step";
    if (!same(before, session.scene())) return "undo does not restore the scene";
    if (done->changed && (!session.redo() || !same(after, session.scene()))) return "redo does not repeat it";
    return "";
}

} // namespace

Result<StepResult> check_act(Subject& s) {
    Engine e = s.random("act");
    Totals totals;
    std::size_t added = 0; // by the first run on the surface of hills
    const auto patience = std::chrono::seconds(s.size(40, 8)); // for random parameters, which may be expensive
    for (const ActionScene& sample : action_scenes(e)) {
        const auto start = std::chrono::steady_clock::now();
        for (std::size_t k = 0; k < s.size(60, 24); ++k) {
            if (k > 1 && std::chrono::steady_clock::now() - start > patience / 3) break;
            const ParamSet values = k == 0 ? ParamSet() : random_values(s.action.table->params, e);
            for (const Ids& selection : selections(*s.action.table, sample)) {
                const std::string what = attempt(sample.name, selection.size(), values);
                s.doing("run() on " + what);
                const io::ActionRun run{.selection = selection, .values = values, .progress = {}};
                totals.most_added = k == 0 ? 0 : totals.most_added;
                if (const std::string wrong = judge_run(s, sample.scene, run, totals); !wrong.empty())
                    return StepResult::failed(what + ": " + wrong);
                if (k == 0) added = std::max(added, totals.most_added);
            }
        }
    }
    return StepResult::passed({{"runs", double(totals.runs)},
                               {"changed something", double(totals.changed)},
                               {"refused", double(totals.refused)},
                               {"seeds compared", double(totals.seeds)},
                               {"objects added by default, at most", double(added)}},
                              totals.changed == 0 ? "it never changed anything here" : "");
}

namespace {

// Parameters with which it calls progress() often enough to be cancelled halfway, if there are any.
ParamSet busy_values(Subject& s, Engine& e, const ActionScene& sample, const Ids& selection) {
    ParamSet busy;
    std::size_t most = 0;
    for (std::size_t k = 0; k < 12; ++k) {
        ParamSet values = k == 0 ? ParamSet() : random_values(s.action.table->params, e);
        std::size_t calls = 0;
        s.doing("run() on " + attempt(sample.name, selection.size(), values));
        (void)io::run_action(sample.scene, s.registry(), s.action,
                             {.selection = selection, .values = values, .progress = [&](float, std::string_view) {
                                  return ++calls < 64;
                              }});
        s.alive();
        if (calls > most) most = calls, busy = std::move(values);
        if (most >= 8) break;
    }
    return busy;
}

} // namespace

Result<StepResult> check_act_stop(Subject& s) {
    constexpr std::uint64_t patience = 100; // changes after the first 0
    std::size_t calls_in_all = 0, stops = 0;
    Engine e = s.random("act-stop");
    for (const ActionScene& sample : action_scenes(e))
        for (const Ids& selection : selections(*s.action.table, sample)) {
            std::size_t calls = 0, stop_at = 1024; // longer runs are cancelled there
            std::uint64_t late = 0;
            io::ActionRun run{.selection = selection,
                              .values = busy_values(s, e, sample, selection),
                              .progress = {},
                              .jobs = nullptr,
                              .late = &late};
            run.progress = [&](float, std::string_view) { return ++calls < stop_at; };
            const std::string attempted = attempt(sample.name, selection.size(), run.values);
            s.doing("run() on " + attempted);
            (void)io::run_action(sample.scene, s.registry(), s.action, run);
            const std::size_t all = calls;
            calls_in_all += all;
            for (std::size_t k = 1; k <= all; k += std::max<std::size_t>(all / s.size(64, 16), 1)) {
                calls = 0, stop_at = k, ++stops;
                const std::string what = fmt::format("{}, stopped at call {} of progress()", attempted, k);
                s.doing("run() on " + what);
                document::Session session(s.registry());
                session.adopt(sample.scene);
                const Scene before = session.scene();
                const auto done = document::run_action(session, s.action.table->id, run);
                s.alive();
                if (done || !done.error().cancelled())
                    return StepResult::failed(what + ": run() continues, and does not report that it was cancelled");
                if (session.history().size() != 0 || session.version() != before.clock ||
                    !same(before, session.scene()))
                    return StepResult::failed(what + ": the scene has changed");
                if (late > patience)
                    return StepResult::failed(
                        fmt::format("{}: after progress() returned 0, run() made {} more changes", what, late));
            }
        }
    return StepResult::passed({{"calls of progress()", double(calls_in_all)}, {"stopped", double(stops)}},
                              calls_in_all == 0 ? "it never calls progress(), so it cannot be stopped" : "");
}

Result<StepResult> check_act_leaks(Subject& s) {
    Engine e = s.random("act-leaks");
    const ActionScene sample = std::move(action_scenes(e)[0]);
    const std::vector<Ids> chosen = selections(*s.action.table, sample);
    std::size_t runs = 0;
    return check_nothing_left("runs", [&]() -> Result<> {
        const Ids& selection = chosen[runs % chosen.size()];
        s.doing(fmt::format("run() number {} on {}", ++runs, attempt(sample.name, selection.size(), {})));
        std::size_t calls = 0; // some of them are cancelled
        const std::size_t stop_at = runs % 3 == 0 ? runs % 7 : ~std::size_t{0};
        (void)io::run_action(sample.scene, s.registry(), s.action,
                             {.selection = selection, .values = {}, .progress = [&](float, std::string_view) {
                                  return ++calls < stop_at;
                              }});
        s.alive();
        return {};
    });
}

Result<StepResult> check_panel(Subject& s) {
    Engine e = s.random("panel");
    const auto catalogue = s.registry().catalogue();
    std::size_t shown = 0, sets = 0;
    const std::size_t draws = s.size(400, 120);
    FakeUi ui(s.panel.table->params, e);
    ui.runs_action = [&](const std::string& id) -> std::string {
        for (const auto& entry : catalogue->actions)
            if (entry.table->id == id) return "";
        return fmt::format("run() names \"{}\", which is not an action of the plugin", id);
    };
    for (std::size_t i = 0; i < draws; ++i) {
        if (i % 8 == 7) ui.values = random_values(s.panel.table->params, e);
        ui.selection = e() % 4;
        const std::string what =
            fmt::format("draw() number {}, {} objects selected, with {}", i + 1, ui.selection, describe(ui.values));
        s.doing(what);
        const auto drawn = plugin::draw_panel(s.panel, ui);
        s.alive();
        if (!drawn) return StepResult::failed(drawn.error().message + "\n  in " + what);
        shown += ui.widgets, sets += ui.sets;
        ui.widgets = ui.sets = 0;
        if (ui.problem.empty() && !ui.groups.empty()) ui.note("draw() returns with an open group: call end_group()");
        if (!ui.problem.empty()) return StepResult::failed(ui.problem + "\n  in " + what);
    }
    return StepResult::passed({{"draws", double(draws)},
                               {"widgets", double(shown)},
                               {"values set", double(sets)},
                               {"actions run", double(ui.runs)}});
}

} // namespace restage::check

// SPDX-License-Identifier: Apache-2.0
// Actions: over scenes with something of everything and with nothing, each size of a selection and any parameters,
// twice the same sound edits that undo takes back; a stop at every call of progress(); a hundred runs. Panels: drawn
// against widgets that answer anything a user might do.
#include "check/export_scenes.hpp"
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

// Equal by what it holds; new geometry and pixels are shared by nobody.
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

// Every thing and every single thing is what it was; slots that stay empty do not count.
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

struct Sample {
    Scene scene;
    const char* name;
};
std::vector<Sample> samples() {
    return {{everything_scene(), "a scene with something of everything"}, {empty_scene(), "a scene without objects"}};
}

Ids objects_of(const Scene& scene) {
    Ids ids;
    scene.instances.each([&](Id<Instance> id, const Instance&) { ids.push_back(id); });
    return ids;
}

std::string attempt(const char* scene, std::size_t selected, const ParamSet& values) {
    return fmt::format("{}, {} objects selected, {}", scene, selected, describe(values));
}

// Selections of several sizes that the action takes, each of another choice.
std::vector<Ids> selections(Engine& e, const model::Action& action, const Ids& all) {
    std::vector<Ids> found;
    for (std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{2}, all.size()}) {
        if (size > all.size() || (size == 0 && action.needs_selection)) continue;
        Ids ids = all;
        for (std::size_t i = ids.size(); i > 1; --i)
            std::swap(ids[i - 1], ids[e() % i]);
        ids.resize(size);
        if (std::ranges::find(found, ids) == found.end()) found.push_back(std::move(ids));
    }
    return found;
}

} // namespace

Result<StepResult> check_act(Subject& s) {
    Engine e = s.random("act");
    std::size_t runs = 0, changed = 0, refused = 0;
    const auto start = std::chrono::steady_clock::now();
    const auto patience = std::chrono::seconds(s.size(40, 8)); // for random parameters, which may ask for much
    for (const Sample& sample : samples()) {
        const Ids all = objects_of(sample.scene);
        for (std::size_t k = 0; k < s.size(60, 24); ++k) {
            if (k > 1 && std::chrono::steady_clock::now() - start > patience) break;
            const ParamSet values = k == 0 ? ParamSet() : random_values(s.action.table->params, e);
            for (const Ids& selection : selections(e, *s.action.table, all)) {
                const std::string what = attempt(sample.name, selection.size(), values);
                const io::ActionRun run{.selection = selection, .values = values, .progress = {}};
                document::Session session(s.registry());
                session.adopt(sample.scene);
                const Scene before = session.scene();
                s.doing("run() on " + what);
                auto first = io::run_action(before, s.registry(), s.action, run);
                auto second = io::run_action(before, s.registry(), s.action, run);
                s.alive();
                ++runs;
                if (first.has_value() != second.has_value())
                    return StepResult::failed(what + ": running it twice, one fails and one does not");
                if (!first) {
                    const std::string& message = first.error().message;
                    if (message.ends_with("gave up and did not say why"))
                        return StepResult::failed(what + ": run() returns 0, and error() was not called");
                    if (message.find("what it returns cannot be taken") != std::string::npos)
                        return StepResult::failed(what + ": " + message);
                    ++refused;
                    continue;
                }
                if (!alike(first->edit, second->edit))
                    return StepResult::failed(what + ": running it twice gives two different edits");
                const auto done = document::apply_action(session, std::move(*first));
                if (!done) return StepResult::failed(what + ": " + done.error().message);
                changed += done->changed;
                if (done->changed && (session.history().size() != 1 || !session.undo()))
                    return StepResult::failed(what + ": it is no one step of the history");
                if (!same(before, session.scene()))
                    return StepResult::failed(what + ": undo does not give the scene back");
            }
        }
    }
    return StepResult::passed(
        {{"runs", double(runs)}, {"changed something", double(changed)}, {"refused", double(refused)}},
        changed == 0 ? "it never changed anything here" : "");
}

Result<StepResult> check_act_stop(Subject& s) {
    constexpr std::uint64_t patience = 100; // changes after the first "stop"
    std::size_t calls_in_all = 0, stops = 0;
    Engine e = s.random("act-stop");
    const Sample sample = samples()[0];
    for (const Ids& selection : selections(e, *s.action.table, objects_of(sample.scene))) {
        std::size_t calls = 0, stop_at = ~std::size_t{0};
        std::uint64_t late = 0;
        io::ActionRun run{.selection = selection, .values = {}, .progress = {}, .jobs = nullptr, .late = &late};
        run.progress = [&](float, std::string_view) { return ++calls < stop_at; };
        s.doing("run() on " + attempt(sample.name, selection.size(), {}));
        (void)io::run_action(sample.scene, s.registry(), s.action, run);
        const std::size_t all = calls;
        calls_in_all += all;
        for (std::size_t k = 1; k <= all; k += std::max<std::size_t>(all / s.size(64, 16), 1)) {
            calls = 0, stop_at = k, ++stops;
            const std::string what =
                fmt::format("{}, stopped at call {} of progress()", attempt(sample.name, selection.size(), {}), k);
            s.doing("run() on " + what);
            const auto done = io::run_action(sample.scene, s.registry(), s.action, run);
            s.alive();
            if (done || !done.error().cancelled())
                return StepResult::failed(what + ": run() goes on and returns something else than a stop");
            if (late > patience)
                return StepResult::failed(
                    fmt::format("{}: after progress() said stop, run() made {} changes more", what, late));
        }
    }
    return StepResult::passed({{"calls of progress()", double(calls_in_all)}, {"stopped", double(stops)}},
                              calls_in_all == 0 ? "it never asks progress(): nobody can stop it" : "");
}

Result<StepResult> check_act_leaks(Subject& s) {
    Engine e = s.random("act-leaks");
    const Sample sample = samples()[0];
    const std::vector<Ids> chosen = selections(e, *s.action.table, objects_of(sample.scene));
    std::size_t runs = 0;
    return check_nothing_left("runs", [&]() -> Result<> {
        const Ids& selection = chosen[runs % chosen.size()];
        s.doing(fmt::format("run() number {} on {}", ++runs, attempt(sample.name, selection.size(), {})));
        std::size_t calls = 0; // some of them are stopped
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
        return fmt::format("run() names \"{}\", which is no action of the plugin", id);
    };
    for (std::size_t i = 0; i < draws; ++i) {
        if (i % 8 == 7) ui.values = random_values(s.panel.table->params, e);
        ui.selection = e() % 4;
        const std::string what =
            fmt::format("draw() number {}, {} objects selected, with {}", i + 1, ui.selection, describe(ui.values));
        s.doing(what);
        plugin::draw_panel(s.panel, ui);
        s.alive();
        shown += ui.widgets, sets += ui.sets;
        ui.widgets = ui.sets = 0;
        if (ui.problem.empty() && !ui.groups.empty()) ui.note("draw() returns with a group that is open: end_group()");
        if (!ui.problem.empty()) return StepResult::failed(ui.problem + "\n  in " + what);
    }
    return StepResult::passed({{"draws", double(draws)},
                               {"widgets", double(shown)},
                               {"values set", double(sets)},
                               {"actions run", double(ui.runs)}});
}

} // namespace restage::check

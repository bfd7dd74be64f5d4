// SPDX-License-Identifier: Apache-2.0
// Actions of plugins for Python.
#include "document/actions.hpp"
#include "values.hpp"
#include "work.hpp"
#include "workspace.hpp"

namespace restage::python {

namespace {

using Shared = std::shared_ptr<Workspace>;

struct ActionInfo { // a copy: the state at the time of the call
    model::Action table;
    std::string plugin;
};

struct Outcome {
    Shared in;
    bool changed = false;
    Objects objects;
    io::Report report;
};

Outcome run(const Shared& w, const std::string& id, nb::handle selection, const nb::object& progress,
            const nb::kwargs& values) {
    auto& registry = w->host().registry();
    const auto entry = take(document::find_action(registry, id));
    io::ActionRun how;
    how.selection = objects_of(*w, selection);
    for (const auto& [key, value] : values) {
        const auto name = nb::cast<std::string>(key);
        const model::Param* line = entry.table->find(name); // run_action reports unknown ones
        how.values.set(name,
                       line ? to_value(w.get(), line->type, value, "parameter \"" + name + "\"") : scene::Value());
    }
    const scene::Scene copy = w->scene();
    io::ActionResult result = work(w->host(), progress, [&](io::Progress tell) {
        how.progress = std::move(tell);
        return io::run_action(copy, registry, entry, how);
    });
    take(document::rebase_action(w->scene(), result)); // other threads may have edited meanwhile
    Outcome out{.in = w, .changed = false, .objects = {}, .report = std::move(result.report)};
    if (!result.edit.changes.empty()) out.changed = w->edit(std::move(result.edit));
    for (const auto object : result.selection)
        if (w->scene().instances.find(object)) out.objects.push_back(object);
    return out;
}

} // namespace

void bind_actions(nb::module_& m, nb::class_<Workspace>& c) {
    nb::class_<ActionInfo>(m, "Action", "An operation on a scene, provided by a plugin.")
        .def_prop_ro(
            "id", [](const ActionInfo& a) { return a.table.id; }, "Its id, as for run_action: \"scatter\".")
        .def_prop_ro(
            "label", [](const ActionInfo& a) { return a.table.label; }, "Its name in menus and in the history.")
        .def_prop_ro(
            "tooltip", [](const ActionInfo& a) { return a.table.tooltip; }, "One sentence about it.")
        .def_ro("plugin", &ActionInfo::plugin, "Id of the plugin that provides it.")
        .def_prop_ro(
            "needs_selection", [](const ActionInfo& a) { return a.table.needs_selection; },
            "True: run_action requires at least one object.")
        .def_prop_ro(
            "parameters",
            [](const ActionInfo& a) {
                nb::dict values;
                for (const model::Param& line : a.table.params)
                    values[line.id.c_str()] = to_python(nullptr, scene::default_value(line));
                return values;
            },
            "Every parameter and its default.", nb::sig("def parameters(self) -> dict[str, object]"))
        .def("__repr__", [](const ActionInfo& a) { return "<restage.Action \"" + a.table.id + "\">"; });
    nb::class_<Outcome>(m, "ActionResult", "The result of an action.")
        .def_ro("changed", &Outcome::changed, "False: it had nothing to do.")
        .def_prop_ro(
            "objects", [](const Outcome& o) { return Selection{o.in, o.objects}; },
            "The objects that it added or selected, as one.")
        .def_ro("report", &Outcome::report, "Its messages, and refused changes: a Report.")
        .def("__repr__", [](const Outcome& o) {
            return "<restage.ActionResult: " + std::to_string(o.objects.size()) + " objects>";
        });
    c.def(
         "actions",
         [](Workspace& w) {
             std::vector<ActionInfo> all;
             const auto catalogue = w.host().registry().catalogue();
             for (const plugin::ActionEntry& entry : catalogue->actions)
                 all.push_back({*entry.table, entry.plugin->manifest.id});
             return all;
         },
         "The actions of all loaded plugins: a list of Action.")
        .def("run_action", &run, "id"_a, "selection"_a = nb::make_tuple(), "progress"_a = nb::none(), "values"_a,
             "Runs an action of a plugin: run_action(\"scatter\", [tree, ground], count=500, seed=3). Its changes are "
             "one\n"
             "undo step, named after its label. selection: objects in order; the last one is the active one.\n"
             "progress(fraction, what): called about 20 times a second; False cancels it, and nothing changes.",
             nb::sig("def run_action(self, id: str, selection: collections.abc.Iterable[Object | Group | Selection] = "
                     "(), progress: collections.abc.Callable[[float, str], bool | None] | None = None, **values: "
                     "object) -> ActionResult"));
}

} // namespace restage::python

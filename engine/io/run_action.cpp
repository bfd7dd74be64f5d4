// SPDX-License-Identifier: Apache-2.0
#include "io/run_action.hpp"

#include "io/edit_writer.hpp"
#include "io/scene_reader.hpp"
#include "scene/validate.hpp"

#include <algorithm>
#include <exception>
#include <optional>
#include <set>

namespace restage::io {

using namespace scene;

namespace {

// "Scatter: failed without giving a reason": the user cannot fix that.
std::string fault(const plugin::ActionEntry& entry, std::string_view what, const std::string& detail = {}) {
    const std::string& version = entry.plugin->manifest.version;
    return entry.table->label + ": " + std::string(what) + (detail.empty() ? "" : ": " + detail) +
           ". Nothing was changed. This is a bug in the plugin " + entry.plugin->name() +
           (version.empty() ? "" : " " + version) +
           ": please report it to its author, with the scene, the selection and the parameters";
}

} // namespace

std::string new_error(const Scene& before, const Scene& after) {
    auto now = validate(after);
    std::erase_if(now, [](const Problem& p) { return p.severity != Problem::Severity::error; });
    if (now.empty()) return ""; // the usual case; the old value is irrelevant
    const auto old = validate(before);
    for (const Problem& p : now)
        if (std::ranges::find(old, p) == old.end()) return p.sentence;
    return "";
}

Result<> check_action_run(const Scene& scene, const model::Action& action, const ActionRun& run) {
    const std::string who = "action \"" + action.id + "\": ";
    if (action.needs_selection && run.selection.empty()) return fail(who + "nothing is selected: select objects first");
    std::set<Id<Instance>> seen;
    for (const Id<Instance> id : run.selection) {
        if (!scene.instances.find(id))
            return fail(who + "the selected object " + std::to_string(id.value) + " does not exist");
        if (!seen.insert(id).second) return fail(who + "\"" + scene.instances[id].name + "\" is selected twice");
    }
    for (const auto& [id, value] : run.values.entries()) {
        const model::Param* line = action.find(id);
        if (!line) {
            std::string known;
            for (const model::Param& p : action.params)
                known += (known.empty() ? "" : ", ") + p.id;
            return fail(who + "there is no parameter \"" + id + "\"; " +
                        (known.empty() ? "it has no parameters" : "known: " + known));
        }
        if (const std::string why = misfit(*line, value); !why.empty())
            return fail(who + "parameter \"" + id + "\"" + why);
        if ((value.texture && !scene.textures.find(value.texture)) ||
            (value.material && !scene.materials.find(value.material)))
            return fail(who + "parameter \"" + id + "\" refers to something that does not exist");
    }
    return {};
}

Result<ActionResult> run_action(const Scene& scene, const plugin::Registry& registry, const plugin::ActionEntry& entry,
                                const ActionRun& run) {
    const model::Action& action = *entry.table;
    RESTAGE_CHECK(check_action_run(scene, action, run));
    ParamSet all; // every parameter, set or default, in the table's order
    for (const model::Param& line : action.params) {
        const Value* given = run.values.find(line.id);
        all.set(line.id, given ? *given : default_value(line));
    }
    const std::vector<RestageValue> values = give_values(all);
    std::vector<RestageHandle> handles;
    for (const Id<Instance> id : run.selection)
        handles.push_back(id.value);
    const RestageSelection1 selection{.size = sizeof(RestageSelection1),
                                      .instance_count = static_cast<std::uint32_t>(handles.size()),
                                      .instances = handles.empty() ? nullptr : handles.data()};
    ActionResult result{.edit = {}, .selection = {}, .report = {}, .base = scene};
    SceneReader reader(result.base, registry, run.progress);
    EditWriter writer(result.base, registry, run.progress);
    std::optional<CrashNote> note(std::in_place, entry.plugin->blame("while it ran \"" + action.label + "\""));
    bool done = false;
    std::optional<std::string> thrown;
    try {
        done = entry.native->run(&reader.table(), &selection, values.empty() ? nullptr : values.data(),
                                 static_cast<std::uint32_t>(values.size()), &writer.edits()) != 0;
    } catch (const std::exception& e) {
        thrown = e.what();
    } catch (...) {
        thrown = "";
    }
    note.reset();
    if (thrown) return fail(fault(entry, threw, *thrown));
    if (run.late) *run.late = writer.late();
    const std::string who = action.label + ": ";
    if (writer.cancelled() || reader.cancelled()) return cancelled(who + "stopped on request");
    if (!writer.error().empty()) return fail(who + writer.error());
    if (!reader.error().empty()) return fail(who + reader.error());
    if (!done) return fail(fault(entry, no_reason));
    std::optional<Jobs> own;
    Jobs& jobs = run.jobs ? *run.jobs : own.emplace(1);
    auto edit = writer.finish(jobs, action.label);
    if (!edit) return fail(fault(entry, unsound, edit.error().message));
    result.edit = std::move(*edit);
    result.selection = writer.selection();
    result.report = std::move(writer.report);
    for (ReportEntry& line : reader.report.entries)
        result.report.entries.push_back(std::move(line));
    return result;
}

} // namespace restage::io

// SPDX-License-Identifier: Apache-2.0
#include "check/supervise.hpp"

#include "base/json.hpp"
#include "base/process.hpp"
#include "check/pictures.hpp"
#include "check/report.hpp"
#include "plugin/manifest.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

namespace restage::check {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

namespace {

constexpr std::string_view mark = "\x1frestage-check "; // unlikely in a plugin's own output

void say(const ordered_json& event) {
    const std::string line =
        std::string(mark) + event.dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n";
    std::fwrite(line.data(), 1, line.size(), stdout);
    std::fflush(stdout);
}

// Why the process ended unexpectedly.
StepResult ended_early(const ProcessOutcome& outcome, const std::string& step, const std::string& of,
                       const Supervision& s) {
    StepResult result;
    result.step = step.empty() ? "load" : step, result.of = of, result.verdict = Verdict::fail;
    const Step* known = find_step(result.step);
    const std::string calls = known ? known->calls : ""; // "": GLSL
    const double limit = std::chrono::duration<double>(s.answer_limit).count();
    switch (outcome.end) {
        case ProcessEnd::silence_limit:
        case ProcessEnd::time_limit:
            result.text =
                !calls.empty()
                    ? fmt::format("no answer from the plugin within {:g} s", limit)
                    : fmt::format("no answer from the GPU within {:g} s: an endless loop in its GLSL?", limit);
            result.cause = !calls.empty() ? calls + " does not return"
                                          : "a loop whose end depends on a number that can be NaN, or is never reached";
            break;
        case ProcessEnd::signalled:
            result.text = fmt::format("the plugin crashed: {}", outcome.what);
            result.cause = calls.empty() ? "GLSL that the driver cannot compile, or freed memory of the plugin"
                                         : "a bug in " + calls +
                                               ", or a table that misstates its size, its count or its "
                                               "pointers";
            break;
        case ProcessEnd::cancelled:
            result.text = "cancelled";
            break;
        default:
            result.text = fmt::format("the plugin ended the program ({})", outcome.what);
            result.cause = "a plugin never calls exit(); it returns 0 or writes to restage.log/1";
    }
    return result;
}

// Whether the steps after this one run in a new process.
bool goes_on(const ProcessOutcome& outcome, const std::string& step) {
    if (step.empty() || step == "manifest" || step == "load" || step == "glsl" || step == "names") return false;
    if (outcome.end == ProcessEnd::cancelled) return false;
    const Step* known = find_step(step);
    const bool hung = outcome.end == ProcessEnd::silence_limit || outcome.end == ProcessEnd::time_limit;
    return known && (*known->calls || !hung); // GLSL that hangs would hang in every step
}

} // namespace

void check_in_process(const fs::path& folder, const CheckOptions& options) {
    auto last = std::chrono::steady_clock::now();
    const auto alive = [&] {
        const auto now = std::chrono::steady_clock::now();
        if (now - last < std::chrono::milliseconds(200)) return;
        last = now;
        say({{"event", "alive"}});
    };
    Subject subject(folder, options, alive);
    subject.say_doing = [](const std::string& what) { say({{"event", "doing"}, {"what", what}}); };
    const auto pictures = [&] {
        const auto file = write_pictures(subject, options.pictures);
        if (file)
            say({{"event", "pictures"}, {"file", file->string()}});
        else
            say({{"event", "step"},
                 {"result", to_json(StepResult{.step = "pictures",
                                               .of = subject.table().type,
                                               .verdict = Verdict::fail,
                                               .text = file.error().message})}});
    };
    run_steps(
        subject,
        [](const std::string& step, const std::string& of) { say({{"event", "begin"}, {"step", step}, {"of", of}}); },
        [](const StepResult& result) { say({{"event", "step"}, {"result", to_json(result)}}); },
        options.pictures.empty() ? std::function<void()>() : pictures);
    if (!subject.no_device().empty()) say({{"event", "unable"}, {"why", subject.no_device()}});
    say({{"event", "end"}});
}

Result<PluginReport> check_plugin(const Supervision& s) {
    PluginReport report;
    report.folder = s.folder, report.id = s.folder.string();
    report.seed = s.options.seed, report.quick = s.options.quick;
    if (const auto manifest = plugin::read_manifest(s.folder / "plugin.json")) {
        report.id = manifest->id, report.version = manifest->version;
        report.kind = manifest->kind();
    }
    std::string step, of, doing;
    bool ended = false;
    std::size_t begun = 0; // number of steps, in all processes
    Process process;
    process.silence_limit = s.answer_limit;
    process.memory_limit = s.memory_limit;
    process.cancel = s.cancel;
    if (!s.options.quick)
        process.environment = {{"MESA_SHADER_CACHE_DISABLE", "true"}}; // driver compile time is measured
    process.on_out = [&](std::string_view line) {
        const std::size_t at = line.find(mark);
        if (at == line.npos) return; // the plugin's own output
        const auto event = parse_json<ordered_json>(line.substr(at + mark.size())).value_or(ordered_json());
        if (!event.is_object()) return;
        const std::string kind = event.value("event", "");
        if (kind == "begin") {
            step = event.value("step", ""), of = event.value("of", ""), doing.clear(), ++begun;
            if (s.on_begin) s.on_begin(step, of);
        } else if (kind == "doing") {
            doing = event.value("what", "");
        } else if (kind == "step" && event.contains("result")) {
            report.steps.push_back(step_from_json(event["result"]));
            if (s.on_step) s.on_step(report, report.steps.back());
        } else if (kind == "pictures") {
            report.pictures.emplace_back(event.value("file", ""));
        } else if (kind == "unable") {
            report.unable = event.value("why", "");
        } else if (kind == "end") {
            ended = true;
        }
    };
    for (bool more = true; more;) {
        process.argv = {s.program.string(), "check",  "--in-process",
                        s.folder.string(),  "--seed", std::to_string(s.options.seed)};
        if (s.options.quick) process.argv.emplace_back("--quick");
        if (!s.options.only.empty()) process.argv.insert(process.argv.end(), {"--only", s.options.only});
        if (!s.options.pictures.empty())
            process.argv.insert(process.argv.end(), {"--pictures", s.options.pictures.string()});
        if (begun > 0) process.argv.insert(process.argv.end(), {"--skip", std::to_string(begun)});
        const std::size_t before = begun;
        step.clear(), of.clear(), doing.clear();
        RESTAGE_TRY(const ProcessOutcome outcome, run_process(process));
        report.seconds += outcome.seconds;
        if (ended && outcome.ok()) break;
        StepResult result = ended_early(outcome, step, of, s);
        if (ended) result.step = "shutdown", result.of = ""; // after its last message
        if (!doing.empty() && !ended) result.text += "\n  in " + doing;
        std::string said = outcome.err;
        while (!said.empty() && said.back() == '\n')
            said.pop_back();
        if (!said.empty()) result.text += "\n  its last output: " + said.substr(said.rfind('\n') + 1);
        report.steps.push_back(std::move(result));
        if (s.on_step) s.on_step(report, report.steps.back());
        // A crash counts for this step only; the others still run.
        more = !ended && begun > before && goes_on(outcome, step);
    }
    return report;
}

Result<std::vector<fs::path>> find_plugins(const fs::path& program, std::span<const std::string> names) {
    std::vector<fs::path> folders;
    std::vector<std::string> unknown;
    for (const std::string& name : names) {
        std::error_code code;
        if (fs::is_regular_file(fs::path(name) / "plugin.json", code))
            folders.push_back(fs::absolute(name, code).lexically_normal());
        else if (fs::is_directory(name, code))
            return fail(name + ": there is no plugin.json in this folder");
        else
            unknown.push_back(name);
    }
    if (!names.empty() && unknown.empty()) return folders;
    // Listing loads them all, hence also in a child process.
    Process list;
    list.argv = {program.string(), "--quiet", "plugins", "--json"};
    list.time_limit = std::chrono::seconds(60);
    std::string json;
    list.on_out = [&](std::string_view line) { json += std::string(line) + "\n"; };
    RESTAGE_TRY(const ProcessOutcome outcome, run_process(list));
    const auto parsed = parse_json<ordered_json>(json).value_or(ordered_json());
    if (!outcome.ok() || !parsed.is_array())
        return fail("listing the plugins failed (" + outcome.what + "): name the folder of each plugin to check");
    const auto provides = [](const ordered_json& p, const std::string& name) {
        if (p.value("id", "") == name) return true;
        const auto list_of = p.value("provides", std::vector<std::string>{});
        return std::any_of(list_of.begin(), list_of.end(), [&](const std::string& what) { // "material diffuse"
            const std::size_t space = what.find(' ');
            return what.substr(space + 1, what.find(" (") - space - 1) == name || what == name;
        });
    };
    if (names.empty())
        for (const auto& p : parsed)
            folders.emplace_back(p.value("folder", ""));
    for (const std::string& name : unknown) {
        const auto it = std::find_if(parsed.begin(), parsed.end(), [&](const auto& p) { return provides(p, name); });
        if (it == parsed.end())
            return fail(name +
                        ": no folder with a plugin.json, and no plugin has this id or provides it "
                        "(`restage plugins` lists them)");
        folders.emplace_back((*it).value("folder", ""));
    }
    if (folders.empty()) return fail("no plugins were found (`restage plugins` says where they are looked for)");
    return folders;
}

} // namespace restage::check

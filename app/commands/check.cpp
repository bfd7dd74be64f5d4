// SPDX-License-Identifier: Apache-2.0
// restage check PLUGIN...: tests plugins against their contract, each in a separate process.
#include "check/report.hpp"
#include "check/supervise.hpp"
#include "commands.hpp"
#include "standard_streams.hpp"

#include "base/file.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

namespace restage::app {
namespace {

struct Options {
    std::vector<std::string> plugins;
    std::string json, junit, markdown;
    check::CheckOptions check;
    double time_limit = 60;
    bool in_process = false;
};

// Problems with the output files, before minutes are spent.
Result<> check_outputs(const Options& o) {
    const std::pair<const char*, const std::string*> all[] = {
        {"--json", &o.json}, {"--junit", &o.junit}, {"--markdown", &o.markdown}};
    for (const auto& [option, file] : all)
        if (auto good = check_file_path(*file); !good) return fail(option, good.error());
    for (const auto& a : all)
        for (const auto& b : all)
            if (&a < &b && !a.second->empty() && *a.second == *b.second)
                return fail(std::string(a.first) + ", " + b.first + ": both would be written to " + *a.second);
    return {};
}

Result<> write_report(const std::string& file, const std::string& text) {
    if (file != "-") return write_file_atomic(file, text);
    std::fputs(text.c_str(), stdout);
    return {};
}

Result<int> run(const Options& o, Context& context) {
    if (o.in_process) {
        check::check_in_process(o.plugins.empty() ? "" : o.plugins[0], o.check);
        return exit_ok;
    }
    RESTAGE_CHECK(check_outputs(o));
    RESTAGE_TRY(const auto program, executable_path());
    RESTAGE_TRY(const auto folders, check::find_plugins(program, o.plugins));
    std::vector<check::PluginReport> reports;
    bool passed = true;
    const bool text = o.json != "-" && o.junit != "-" && o.markdown != "-";
    for (const auto& folder : folders) {
        check::Supervision s;
        s.program = program, s.folder = folder, s.options = o.check;
        s.answer_limit = std::chrono::milliseconds(static_cast<long>(o.time_limit * 1000));
        bool begun = false;
        s.on_step = [&](const check::PluginReport& so_far, const check::StepResult& step) {
            if (!text || (context.quiet && step.verdict != check::Verdict::fail)) return;
            if (!std::exchange(begun, true)) std::printf("%s\n", check::headline(so_far).c_str());
            std::fputs(check::text_of(step, so_far).c_str(), stdout);
            std::fflush(stdout);
        };
        RESTAGE_TRY(check::PluginReport report, check::check_plugin(s));
        passed = passed && report.passed();
        if (text) {
            for (const auto& page : report.pictures)
                std::printf("  pictures     %s\n", page.string().c_str());
            std::printf("  %s\n", check::verdict_line(report).c_str());
        }
        if (!report.unable.empty())
            context.log.error(report.id +
                              ": its GLSL was not checked, as this machine cannot run it: " + report.unable);
        reports.push_back(std::move(report));
    }
    if (!o.json.empty()) {
        nlohmann::ordered_json all = nlohmann::ordered_json::array();
        for (const auto& r : reports)
            all.push_back(check::to_json(r));
        RESTAGE_CHECK(
            write_report(o.json, all.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n"));
    }
    if (!o.junit.empty()) RESTAGE_CHECK(write_report(o.junit, check::junit(reports)));
    if (!o.markdown.empty()) RESTAGE_CHECK(write_report(o.markdown, check::markdown(reports)));
    const bool taken = std::ranges::any_of(reports, [&](const check::PluginReport& r) {
        return std::ranges::any_of(r.steps, [&](const auto& s) { return s.step == o.check.only; });
    });
    if (!o.check.only.empty() && !taken && passed)
        return fail("--only " + o.check.only + ": this step applies to none of the plugins that were checked");
    return passed ? exit_ok : exit_failed;
}

} // namespace

void add_check(CLI::App& program, Context& context) {
    auto o = std::make_shared<Options>();
    auto* command = program.add_subcommand("check", "Test whether plugins meet their contract");
    command->add_option(
        "PLUGIN", o->plugins,
        "Folder with a plugin.json, id of a plugin, or name of something it provides, for example diffuse (default: "
        "all plugins)");
    command->add_option("--json", o->json, "Write the reports as JSON (- = stdout, instead of text)")
        ->type_name("FILE");
    command->add_option("--junit", o->junit, "Write them as JUnit XML, for CI (- = stdout)")->type_name("FILE");
    command->add_option("--markdown", o->markdown, "Write them as a table in Markdown (- = stdout)")->type_name("FILE");
    command
        ->add_option("--pictures", o->check.pictures,
                     "Write a page of pictures of each material, as HTML, into this folder")
        ->type_name("FOLDER");
    command->add_option("--seed", o->check.seed, "Seed of all random numbers; the seed in a report replays its failure")
        ->capture_default_str();
    std::vector<std::string> names;
    for (const auto* steps : check::all_steps())
        for (const check::Step& s : *steps)
            names.emplace_back(s.name);
    command->add_option("--only", o->check.only, "Run only this step (and manifest and load)")
        ->check(CLI::IsMember(names))
        ->type_name("STEP");
    command->add_flag("--quick", o->check.quick, "A few seconds per plugin: fewer configurations and samples");
    command->add_option("--time-limit", o->time_limit, "Longest time without a response from the plugin or the GPU [s]")
        ->check(CLI::Range(0.001, 86400.0))
        ->capture_default_str();
    command->add_flag("--in-process", o->in_process)->group(""); // for the processes this command starts
    command->add_option("--skip", o->check.skip)->group("");
    add_example(*command, "restage check my-plugins/velvet --quick");
    command->callback([&context, o] { context.choose([&context, o] { return run(*o, context); }); });
}

} // namespace restage::app

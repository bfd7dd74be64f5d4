// SPDX-License-Identifier: Apache-2.0
// The program `restage`: parses the command line, runs one command, returns its exit code (see ExitCode).

#include "base/version.hpp"
#include "commands/commands.hpp"
#include "usage.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

namespace {

bool has_display() {
#if defined(__linux__)
    return std::getenv("DISPLAY") || std::getenv("WAYLAND_DISPLAY");
#else
    return true;
#endif
}

int run(int argc, char** argv) {
    using namespace restage::app;
    Context context;
    CLI::App program{"Restage: edit, path-trace, denoise and convert 3D scenes."};
    program.name("restage");
    program.set_version_flag("-V,--version", std::string("restage ") + restage::version());
    program.set_help_flag("-h,--help", "Show this help and exit");
    program.require_subcommand(0, 1);
    program.fallthrough(); // options of the program are accepted after the command as well
    program.failure_message([](const CLI::App* app, const CLI::Error& error) { return usage_sentence(*app, error); });
    program.footer(
        "Exit codes: 0 done, 1 failed, 2 invalid command line, 128 + N stopped by signal N. Data goes to "
        "stdout, the "
        "log to stderr.");
    program.add_flag_callback("-v,--verbose", [&] { context.log.set_threshold(restage::LogLevel::debug); }, "Log more");
    program.add_flag_callback(
        "-q,--quiet",
        [&] {
            context.log.set_threshold(restage::LogLevel::error);
            context.quiet = true;
        },
        "Log errors only");
    program.add_flag("--safe-mode", context.safe_mode, "Load only the plugins shipped with the program");
    program
        .add_option("--plugin-path", context.plugin_paths,
                    "Search this folder for plugins first (may be repeated; RESTAGE_PLUGIN_PATH adds more)")
        ->allow_extra_args(false);
    program.add_flag("--isolate", context.isolate, "Read scene files in a separate process: for untrusted files");
    program.add_option("--isolate-time", context.isolate_seconds, "Limit for that process [s]")
        ->check(CLI::Range(1.0, 86400.0))
        ->capture_default_str();
    program.add_option("--isolate-memory", context.isolate_gib, "Limit for that process [GiB of address space]")
        ->check(CLI::Range(0.5, 4096.0))
        ->capture_default_str();
    for (auto* add : all_commands)
        add(program, context);
    forbid_empty_values(program);

    // `restage SCENE` is `restage edit SCENE`, and plain `restage` opens the editor if there is a display.
    std::vector<std::string> arguments(argv + 1, argv + argc);
    const bool is_file = !arguments.empty() && !arguments[0].starts_with("-") &&
                         program.get_subcommands([&](CLI::App* c) { return c->get_name() == arguments[0]; }).empty() &&
                         arguments[0].find('.') != std::string::npos;
    if (is_file || (arguments.empty() && has_display())) arguments.insert(arguments.begin(), "edit");
    std::reverse(arguments.begin(), arguments.end()); // in CLI11's order

    try {
        program.parse(arguments);
    } catch (const CLI::ParseError& error) {
        return program.exit(error) == 0 ? exit_ok : exit_usage; // --help and --version also arrive here
    }
    if (!context.chosen()) {
        std::fputs(program.help().c_str(), stderr);
        return exit_usage;
    }
    return context.run();
}

} // namespace

int main(int argc, char** argv) {
    try {
        return run(argc, argv);
    } catch (const std::exception& error) { // a bug, or out of memory
        std::fprintf(stderr, "restage: internal error: %s\n", error.what());
        return restage::app::exit_failed;
    }
}

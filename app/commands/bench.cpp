// SPDX-License-Identifier: Apache-2.0
// restage bench SCENE...: the Python package measures (python/restage/bench); this starts its interpreter.
#include "base/file.hpp"
#include "commands.hpp"

#include <CLI/CLI.hpp>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <memory>

#if defined(_WIN32)
#include <process.h>
#else
#include <unistd.h>
#endif

namespace restage::app {
namespace {

void set_variable(const char* name, const std::string& value) {
#if defined(_WIN32)
    _putenv_s(name, value.c_str());
#else
    setenv(name, value.c_str(), 1);
#endif
}

// Returns only if the interpreter cannot be started.
Result<int> run(const std::vector<std::string>& arguments) {
    RESTAGE_TRY(const std::filesystem::path folder, executable_dir());
    const std::filesystem::path packages = folder.parent_path() / "lib/python"; // in a wheel it is importable anyway
    if (std::filesystem::exists(packages / "restage")) {
        const char* others = std::getenv("PYTHONPATH");
        const std::string separator(1, std::filesystem::path::preferred_separator == '/' ? ':' : ';');
        set_variable("PYTHONPATH", packages.string() + (others && *others ? separator + others : ""));
    }
    const char* chosen = std::getenv("RESTAGE_PYTHON"); // of `python -m restage`, or the user's
    const std::string python = chosen && *chosen ? chosen : "python3";
    std::vector<std::string> words{python, "-m", "restage.bench"};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> argv;
    for (std::string& word : words)
        argv.push_back(word.data());
    argv.push_back(nullptr);
#if defined(_WIN32)
    const auto code = _spawnvp(_P_WAIT, argv[0], argv.data());
    if (code >= 0) return int(code);
#else
    execvp(argv[0], argv.data());
#endif
    return fail(python + ": cannot be started: " + std::strerror(errno) +
                "; RESTAGE_PYTHON names the Python that has numpy");
}

} // namespace

void add_bench(CLI::App& program, Context& context) {
    auto* command = program.add_subcommand(
        "bench", "Chart error against samples and time, of configurations and of other renderers; needs Python");
    command->fallthrough(false)->prefix_command(); // its arguments are the package's
    add_example(
        *command,
        "restage bench room.pbrt -o page --mitsuba python3\n"
        "Arguments (`python3 -m restage.bench --help` explains them): SCENE..., -o FOLDER, --rows FILE, --size WxH, "
        "--samples N..., --seeds N, --reference PFM..., --reference-spp N, --reference-parts N, --target ERROR, "
        "--mitsuba PYTHON, --cycles PYTHON, --pbrt BINARY, --growth [KIND...], --budget SECONDS");
    command->callback(
        [&context, command] { context.choose([arguments = command->remaining()] { return run(arguments); }); });
}

} // namespace restage::app

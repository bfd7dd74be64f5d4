// SPDX-License-Identifier: Apache-2.0
// Context: shared by all commands of the program: the log, the plugins (loaded on first use), and the work of the
// chosen command, which runs after the command line has been parsed.
#pragma once

#include "base/log.hpp"
#include "base/result.hpp"
#include "io/services.hpp"
#include "plugin/registry.hpp"
#include "progress.hpp"

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace restage::app {

// Data goes to stdout, everything else to stderr.
enum ExitCode : int {
    exit_ok = 0,
    exit_failed = 1, // valid, but failed
    exit_usage = 2   // invalid: unknown option, missing argument
};

inline plugin::RegistryOptions registry_options(bool safe_mode) {
    return io::with_services({.safe_mode = safe_mode, .quarantine = plugin::Registry::default_quarantine()});
}

inline std::vector<plugin::SearchPath> search_paths(const std::vector<std::string>& first) {
    std::vector<plugin::SearchPath> paths;
    for (const std::string& folder : first)
        paths.push_back({.folder = folder, .required = true});
    for (auto& path : plugin::Registry::default_paths())
        paths.push_back(std::move(path));
    return paths;
}

class Context {
  public:
    using Run =
        std::function<Result<int>()>; // an ExitCode; an error is logged and becomes exit_failed, or the signal's

    Log log;
    bool quiet = false;
    bool safe_mode = false; // the program's own plugins only
    std::vector<std::string> plugin_paths; // searched first
    bool isolate = false; // scenes are read in a separate process
    double isolate_seconds = 300, isolate_gib = 4; // its limits

    // The plugins, loaded on first use.
    plugin::Registry& registry() {
        if (!registry_) {
            registry_ = std::make_unique<plugin::Registry>(log, registry_options(safe_mode));
            registry_->scan(search_paths(plugin_paths));
        }
        return *registry_;
    }

    // For a command's CLI11 callback: parsing only chooses, main() runs it afterwards.
    void choose(Run run) { run_ = std::move(run); }
    bool chosen() const { return static_cast<bool>(run_); }
    int run() {
        auto code = run_();
        if (code) return *code;
        if (code.error().cancelled()) {
            log.warning(code.error().message);
            return interrupt_exit_code();
        }
        log.error(code.error().message);
        return exit_failed;
    }

  private:
    std::unique_ptr<plugin::Registry> registry_;
    Run run_;
};

} // namespace restage::app

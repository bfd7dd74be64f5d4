// SPDX-License-Identifier: Apache-2.0
#include "host.hpp"
#include "io/services.hpp"

#include "render/material_composer.hpp"
#include "render/texture_composer.hpp"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <new>
#if defined(__unix__) || defined(__APPLE__)
#include <pthread.h>
#include <unistd.h>
#endif

namespace restage::python {

namespace fs = std::filesystem;

namespace {

fs::path& home_path() {
    static fs::path path;
    return path;
}

std::atomic<bool> threads_began = false, is_forked = false;

// Created on first use. A forked child does not destroy it: its plugins would wait for their threads.
struct HostKeeper {
    std::shared_ptr<Host> host = std::make_shared<Host>(Host::home());
    HostKeeper() = default;
    HostKeeper(const HostKeeper&) = delete;
    ~HostKeeper() {
        if (is_forked) new (std::nothrow) std::shared_ptr<Host>(std::move(host));
    }
};

int python_level(LogLevel level) { // of Python's logging
    switch (level) {
        case LogLevel::debug:
            return 10;
        case LogLevel::info:
            return 20;
        case LogLevel::warning:
            return 30;
        case LogLevel::error:
            break;
    }
    return 40;
}

} // namespace

void Host::set_home(fs::path path) { home_path() = std::move(path); }
const fs::path& Host::home() { return home_path(); }

const std::shared_ptr<Host>& Host::get() {
    static const HostKeeper keeper;
    if (!is_forked) keeper.host->flush_log();
    return keeper.host;
}

void Host::begin_threads() {
    if (is_forked)
        throw Failure(
            "this process is a fork() of one that had rendered or denoised, and a fork does not have its "
            "threads; start workers as new processes (multiprocessing.get_context(\"spawn\") or "
            "\"forkserver\"), or fork before the first render");
#if defined(__unix__) || defined(__APPLE__)
    static const int registered = pthread_atfork(nullptr, nullptr, [] {
        is_forked = threads_began.load();
#ifdef __GLIBC__
        // Drivers' exit handlers would also wait for their threads: ours runs first.
        if (is_forked) on_exit([](int status, void*) { std::fflush(nullptr), _exit(status); }, nullptr);
#endif
    });
    (void)registered;
#endif
    threads_began = true;
}

bool Host::forked() { return is_forked; }

Host::Host(const fs::path& home)
    : log_([this](LogLevel level, std::string_view line) {
          const std::lock_guard lock(queue_mutex_);
          queue_.emplace_back(level, line);
      }),
      registry_(log_, io::with_services({.quarantine = plugin::Registry::default_quarantine()})) {
    registry_.scan(plugin::Registry::default_paths(home));
    registry_.set_judge(render::material_judge(home / "share/restage/shaders"),
                        render::texture_judge(home / "share/restage/shaders"));
}

std::vector<const plugin::Entry*> Host::load(const fs::path& folder) {
    const std::unique_lock alone(in_use_, std::try_to_lock);
    if (!alone)
        throw Failure(folder.string() +
                      ": plugins cannot be loaded while a scene is read, written or rendered; wait "
                      "for that first");
    if (!fs::is_directory(folder)) throw Failure(folder.string() + ": there is no such folder");
    const plugin::SearchPath paths[] = {{folder, true}};
    registry_.scan(paths);
    const std::string below = fs::absolute(folder).lexically_normal().generic_string();
    const std::string prefix = below.ends_with('/') ? below : below + '/';
    std::vector<const plugin::Entry*> found;
    for (const plugin::Entry* entry : registry_.entries())
        if ((entry->folder.generic_string() + '/').starts_with(prefix)) found.push_back(entry);
    flush_log();
    if (found.empty()) throw Failure(folder.string() + ": contains no plugin (a folder with a plugin.json)");
    return found;
}

void Host::flush_log() {
    std::vector<std::pair<LogLevel, std::string>> lines;
    {
        const std::lock_guard lock(queue_mutex_);
        lines.swap(queue_);
    }
    if (lines.empty()) return;
    const nb::object logger = nb::module_::import_("logging").attr("getLogger")("restage");
    for (const auto& [level, line] : lines)
        logger.attr("log")(python_level(level), "%s", line);
}

} // namespace restage::python

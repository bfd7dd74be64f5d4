// SPDX-License-Identifier: Apache-2.0
// Host: the plugins and the log that all sessions of a Python process share. Created on first use.
#pragma once

#include "convert.hpp"

#include "base/log.hpp"
#include "plugin/registry.hpp"

#include <filesystem>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <utility>
#include <vector>

namespace restage::python {

class Host {
  public:
    // The folder with lib/restage/plugins and share/restage: next to the package or above it.
    static void set_home(std::filesystem::path);
    static const std::filesystem::path& home();
    static const std::shared_ptr<Host>& get();

    explicit Host(const std::filesystem::path& home);

    // Rendering, denoising and the material lab start threads (Embree's, Vulkan's, the denoiser's) that live on. A
    // fork() does not have them, and waiting for one would block forever: so these announce their start, and are
    // refused in a child forked after that. Such a child does not free sessions either.
    static void begin_threads(); // throws Failure in such a child
    static bool forked(); // whether this is such a child

    Log& log() { return log_; }
    plugin::Registry& registry() { return registry_; }
    // Held shared while a thread without the GIL uses plugins; load() needs it alone.
    std::shared_mutex& in_use() { return in_use_; }
    // The plugins below the folder, including refused ones; those loaded before stay.
    std::vector<const plugin::Entry*> load(const std::filesystem::path& folder);

    // Passes lines logged meanwhile to Python's logger "restage". Threads without the GIL only queue them: waiting
    // for the GIL inside the log's lock could deadlock. [GIL]
    void flush_log();

  private:
    std::mutex queue_mutex_;
    std::vector<std::pair<LogLevel, std::string>> queue_;
    Log log_;
    plugin::Registry registry_;
    std::shared_mutex in_use_;
};

void bind_plugins(nb::module_&);

} // namespace restage::python

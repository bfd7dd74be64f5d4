// SPDX-License-Identifier: Apache-2.0
// Host: the plugins and the log that all sessions of a Python process share. Made at first use.
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
    // Where lib/restage/plugins and share/restage are: beside the package or above it.
    static void set_home(std::filesystem::path);
    static const std::filesystem::path& home();
    static const std::shared_ptr<Host>& get();

    explicit Host(const std::filesystem::path& home);

    // Rendering, denoising and the material lab start threads (Embree's, Vulkan's, the denoiser's) that live on. A
    // fork() has none of them, and whoever waits for one waits for ever: so these say first that they begin, and in a
    // child of a process where one had begun they are refused. What a session holds is not freed there either.
    static void begin_threads(); // throws Failure in such a child
    static bool forked(); // is this such a child?

    Log& log() { return log_; }
    plugin::Registry& registry() { return registry_; }
    // Held shared while a thread without the GIL uses plugins; load() needs it alone.
    std::shared_mutex& in_use() { return in_use_; }
    // What lies below the folder, refused ones too; what was loaded before stays as it is.
    std::vector<const plugin::Entry*> load(const std::filesystem::path& folder);

    // Gives what was logged meanwhile to Python's logger "restage". Threads without the GIL only queue it: one that
    // waited for the GIL in the log's lock could wait for ever. [GIL]
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

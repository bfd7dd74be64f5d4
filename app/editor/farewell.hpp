// SPDX-License-Identifier: Apache-2.0
// Farewell: work to do before the program is terminated from outside (SIGTERM, SIGHUP, SIGINT; a lost display). The
// signal handler only writes a byte into a pipe; a thread reads it and wakes the main loop. A second signal has its
// default effect. At most one Farewell per process.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>

namespace restage::editor {

class Farewell {
  public:
    // `wake` [any]: requests another iteration of the main loop. `last_words`: called when the display is lost and
    // its library is about to end the process; then the main thread either does not hold the `busy()` lock, or is
    // inside a call to the display. Created on the main thread, after the window.
    Farewell(std::function<void()> wake, std::function<void()> last_words);
    ~Farewell();
    Farewell(const Farewell&) = delete;
    Farewell& operator=(const Farewell&) = delete;

    int signal() const; // that was caught; 0 = none
    // The main thread holds it while it changes state that `last_words` reads.
    std::timed_mutex& busy();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

std::string signal_name(int signal); // "SIGTERM"

} // namespace restage::editor

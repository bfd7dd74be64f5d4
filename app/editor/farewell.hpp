// SPDX-License-Identifier: Apache-2.0
// Farewell: the program is ended from outside (SIGTERM, SIGHUP, SIGINT; a lost display), and has something to do
// before. Signals are caught by a handler that only writes a byte into a pipe; a thread reads it and wakes the main
// loop. A second signal ends the program as by default. At most one Farewell per process.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>

namespace restage::editor {

class Farewell {
  public:
    // `wake` [any]: asks the main loop for another turn. `last_words`: what to do when the display is lost,
    // where its library is about to end the process; by then the main thread either has no `busy()` lock, or is within
    // a call to the display. Made on the main thread, after the window.
    Farewell(std::function<void()> wake, std::function<void()> last_words);
    ~Farewell();
    Farewell(const Farewell&) = delete;
    Farewell& operator=(const Farewell&) = delete;

    int signal() const; // that was caught; 0 = none
    // The main thread holds it while it changes what `last_words` looks at.
    std::timed_mutex& busy();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

std::string signal_name(int signal); // "SIGTERM"

} // namespace restage::editor

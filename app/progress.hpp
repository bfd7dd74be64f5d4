// SPDX-License-Identifier: Apache-2.0
// Progress on stderr: a bar with the time left on a terminal, a line now and then elsewhere; and Ctrl-C as a flag.
#pragma once

#include <chrono>
#include <string>

namespace restage::app {

class ProgressBar {
  public:
    explicit ProgressBar(bool quiet = false);
    ~ProgressBar(); // ends the line
    // done in [0,1]; `note` stands behind the bar: "12/64 spp"
    void show(double done, const std::string& note);
    void finish();

  private:
    bool terminal_, quiet_, open_ = false;
    std::chrono::steady_clock::time_point start_, last_;
    double last_done_ = -1;
};

// From the first call on, SIGINT (Ctrl-C), SIGTERM and SIGHUP (a batch system's time limit, a closed terminal) set a
// flag instead of ending the program; a second one ends it. What was ignored when the program started (nohup) stays
// ignored.
void catch_interrupts();
bool interrupted();
int interrupt_exit_code(); // 128 + the signal's number, as shells have it

} // namespace restage::app

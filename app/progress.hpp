// SPDX-License-Identifier: Apache-2.0
// Progress on stderr: on a terminal a bar with the time left, elsewhere an occasional line; and Ctrl-C as a flag.
#pragma once

#include <chrono>
#include <string>

namespace restage::app {

class ProgressBar {
  public:
    explicit ProgressBar(bool quiet = false);
    ~ProgressBar(); // ends the line
    // done in [0,1]; `note` is shown after the bar: "12/64 spp"
    void show(double done, const std::string& note);
    void finish();

  private:
    bool terminal_, quiet_, open_ = false;
    std::chrono::steady_clock::time_point start_, last_;
    double last_done_ = -1;
};

// From the first call on, SIGINT (Ctrl-C), SIGTERM and SIGHUP (a batch system's time limit, a closed terminal) set a
// flag instead of ending the program; a second one ends it. Signals ignored at program start (nohup) stay
// ignored.
void catch_interrupts();
bool interrupted();
int interrupt_exit_code(); // 128 + the signal's number, as in shells

} // namespace restage::app

// SPDX-License-Identifier: Apache-2.0
#include "progress.hpp"

#include <fmt/format.h>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#ifdef _WIN32
#include <io.h>
#define isatty _isatty
#define fileno _fileno
#else
#include <unistd.h>
#endif

namespace restage::app {
namespace {

// Lock-free, so a signal handler may use them. A second Ctrl-C ends the program; one that arrives within half a second
// is the same key press delivered to the process and to its group.
std::atomic<bool> interrupt_asked = false;
std::atomic<std::int64_t> interrupt_time = 0; // [ms]
std::atomic<int> interrupt_signal = SIGINT; // the first
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free);

void on_interrupt(int signal) {
    const auto now =
        std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now().time_since_epoch());
    if (!interrupt_asked.exchange(true)) {
        interrupt_time = now.count();
        interrupt_signal = signal;
    } else if (now.count() - interrupt_time > 500) {
        std::_Exit(128 + signal);
    }
    std::signal(signal, on_interrupt); // some systems reset it
}

std::string clock_text(double seconds) {
    const long s = std::lround(seconds);
    return s < 60 ? fmt::format("{} s", s) : fmt::format("{}:{:02} min", s / 60, s % 60);
}

} // namespace

ProgressBar::ProgressBar(bool quiet)
    : terminal_(isatty(fileno(stderr)) != 0), quiet_(quiet), start_(std::chrono::steady_clock::now()), last_(start_) {}

ProgressBar::~ProgressBar() { finish(); }

void ProgressBar::show(double done, const std::string& note) {
    if (quiet_) return;
    const auto now = std::chrono::steady_clock::now();
    const double since = std::chrono::duration<double>(now - last_).count();
    // Outside a terminal only long work gets a line.
    if (terminal_ ? last_done_ >= 0 && since < 0.1 && done < 1 : since < 10) return;
    last_ = now;
    last_done_ = done;
    const double elapsed = std::chrono::duration<double>(now - start_).count();
    const std::string left = done > 0.01 && done < 1 ? ", " + clock_text(elapsed / done - elapsed) + " left" : "";
    if (terminal_) {
        std::string bar(32, '.');
        bar.replace(0, std::size_t(32 * done), std::size_t(32 * done), '#');
        std::fprintf(stderr, "\r\033[K[%s] %3.0f %%  %s%s", bar.c_str(), 100 * done, note.c_str(), left.c_str());
        std::fflush(stderr);
        open_ = true;
    } else if (done > 0) {
        std::fprintf(stderr, "%3.0f %%  %s%s\n", 100 * done, note.c_str(), left.c_str());
    }
}

void ProgressBar::finish() {
    if (open_) std::fputs("\r\033[K", stderr);
    open_ = false;
}

void catch_interrupts() {
    const auto hear = [](int signal) {
        if (std::signal(signal, on_interrupt) == SIG_IGN) std::signal(signal, SIG_IGN);
    };
    hear(SIGINT);
    hear(SIGTERM);
#ifdef SIGHUP
    hear(SIGHUP);
#endif
}
int interrupt_exit_code() { return 128 + interrupt_signal; }
bool interrupted() { return interrupt_asked; }

} // namespace restage::app

// SPDX-License-Identifier: Apache-2.0
// Runs another program (no shell in between), with captured output and limits: for work that may crash,
// hang or exhaust memory, such as an unknown plugin. POSIX; on Windows run_process returns an error.
#pragma once

#include "base/result.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace restage {

struct Process {
    std::vector<std::string> argv; // argv[0] is the program's path
    std::vector<std::pair<std::string, std::string>> environment; // added to ours
    std::chrono::milliseconds time_limit{0};    // wall clock; 0 = none
    std::chrono::milliseconds silence_limit{0}; // between two lines of output; 0 = none
    std::uint64_t memory_limit = 0;             // bytes of address space; 0 = none
    // Complete lines without their newline, on the calling thread. If null, the output is kept instead.
    std::function<void(std::string_view line)> on_out, on_err;
    const std::atomic<bool>* cancel = nullptr; // polled every 50 ms
};

enum class ProcessEnd { exited, signalled, time_limit, silence_limit, cancelled };

struct ProcessOutcome {
    ProcessEnd end = ProcessEnd::exited;
    int code = 0; // exit code, or number of the signal
    std::string out, err; // at most the last 256 KiB of each
    double seconds = 0;
    bool ok() const { return end == ProcessEnd::exited && code == 0; }
    // "exit code 3", "SIGSEGV (Segmentation fault)", "no end within 5 s", "no sign of life for 5 s", "cancelled"
    std::string what;
};

// Waits for it to end. The program and all it started are killed when a limit is reached, and when we end.
// Its standard input is empty. An error means that it could not be started at all.
Result<ProcessOutcome> run_process(const Process&);

} // namespace restage

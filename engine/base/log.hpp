// SPDX-License-Identifier: Apache-2.0
// The log: levelled lines to a sink that the owner of the process chooses (stderr by default). [any] thread.
// Passed by reference; there is no global.
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <string_view>

namespace restage {

enum class LogLevel { debug, info, warning, error };

class Log {
  public:
    using Sink = std::function<void(LogLevel, std::string_view line)>;

    Log();                        // writes "restage: warning: ..." to stderr, from `info` upwards
    explicit Log(Sink sink);      // everything goes to `sink`, one call at a time
    void set_threshold(LogLevel); // lower levels are dropped

    void debug(std::string_view line) { write(LogLevel::debug, line); }
    void info(std::string_view line) { write(LogLevel::info, line); }
    void warning(std::string_view line) { write(LogLevel::warning, line); }
    void error(std::string_view line) { write(LogLevel::error, line); }
    void write(LogLevel level, std::string_view line);

  private:
    std::mutex mutex_;
    Sink sink_;
    LogLevel threshold_ = LogLevel::info;
};

} // namespace restage

// SPDX-License-Identifier: Apache-2.0
#include "base/log.hpp"

#include <cstdio>
#include <utility>

namespace restage {

namespace {

void to_stderr(LogLevel level, std::string_view line) {
    const char* word = level == LogLevel::error     ? "error: "
                       : level == LogLevel::warning ? "warning: "
                       : level == LogLevel::debug   ? "debug: "
                                                    : "";
    std::string text = "restage: ";
    text.append(word).append(line).append("\n");
    std::fwrite(text.data(), 1, text.size(), stderr);
}

} // namespace

Log::Log() : sink_(to_stderr) {}
Log::Log(Sink sink) : sink_(std::move(sink)), threshold_(LogLevel::debug) {}

void Log::set_threshold(LogLevel level) {
    std::lock_guard lock(mutex_);
    threshold_ = level;
}

void Log::write(LogLevel level, std::string_view line) {
    std::lock_guard lock(mutex_);
    if (level >= threshold_ && sink_) sink_(level, line);
}

} // namespace restage

// SPDX-License-Identifier: Apache-2.0
// Notices: short messages that fade over the viewport, and the log that keeps them.
#pragma once

#include "base/log.hpp"

#include <deque>
#include <mutex>
#include <string>

namespace restage::editor {

struct LogLine {
    LogLevel level = LogLevel::info;
    std::string text;
    double time = 0; // since the program started [s]
};

class Notices {
  public:
    // [any]
    void add(LogLevel level, std::string text);
    // [main] Draws recent messages in the lower right corner of the rectangle.
    void draw(float right, float bottom);
    bool fading() const; // something is on screen
    std::deque<LogLine> lines() const; // a copy, oldest first, at most 2000
    std::size_t count() const;

  private:
    mutable std::mutex mutex_;
    std::deque<LogLine> lines_;
    std::size_t total_ = 0;
};

} // namespace restage::editor

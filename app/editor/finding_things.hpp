// SPDX-License-Identifier: Apache-2.0
// FindingThings: finds the document's things (query/things.hpp) on its own thread: all of them once it is opened, then
// those among objects that appear. What belongs together stays so wherever it is moved. [main], except the thread.
#pragma once

#include "query/things.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <future>

namespace restage::editor {

class SelectContext;

class FindingThings {
  public:
    explicit FindingThings(std::function<void()> wake) : wake_(std::move(wake)) {}
    ~FindingThings() { stop(); }
    FindingThings(const FindingThings&) = delete;
    FindingThings& operator=(const FindingThings&) = delete;

    void follow(SelectContext& editor); // once a frame
    bool running() const { return found_.valid(); }
    void stop(); // of a closed document

  private:
    std::function<void()> wake_;
    std::future<query::Things> found_;
    bool all_ = true; // it finds those of the whole document
    std::atomic<bool> stop_ = false;
};

} // namespace restage::editor

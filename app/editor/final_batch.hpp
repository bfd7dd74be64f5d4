// SPDX-License-Identifier: Apache-2.0
// FinalBatch: the queue of a batch of final pictures. A worker renders what comes next, while the user changes the
// order of those that wait, and cancels some.
#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace restage::editor {

class PanelUi;

class FinalBatch { // [any]
  public:
    enum class State { waits, renders, done, cancelled, failed };
    struct Line {
        std::size_t shot = 0; // index, as created
        std::string name;
        State state = State::waits;
        double done = 0; // 0..1
        bool enough = false; // it ends with the samples it has
    };
    explicit FinalBatch(const std::vector<std::string>& names);

    // Of the worker: the first that waits, which is then the one that renders; none = all are through.
    std::optional<std::size_t> next();
    void report(double done); // of the one that renders
    void finish(State state); // likewise
    bool cancelled() const; // likewise: it is wanted no more
    bool enough() const;
    double done() const; // of all that are not cancelled
    std::string count() const; // "2 of 5, ": the one that renders among them; "" = none does

    // Of the user. Shots that are through, or unknown, are left alone.
    std::vector<Line> lines() const; // in order
    void move(std::size_t shot, int by); // -1: before the one that waits before it; 1: behind
    void put(std::size_t shot, std::size_t at); // to the place of that one: both must wait
    void cancel(std::size_t shot);
    void finish_early(std::size_t shot);

  private:
    Line* find(std::size_t shot);
    const Line* rendering() const;

    mutable std::mutex mutex_;
    std::vector<Line> lines_;
};

// The list with its buttons, inside a window.
void draw_batch(PanelUi& editor, FinalBatch& batch, bool can_finish_early);

} // namespace restage::editor

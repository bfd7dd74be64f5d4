// SPDX-License-Identifier: Apache-2.0
// Pulse: lets Python stop long work without the GIL, by Ctrl-C or the script's callback. `release` is held while the
// work runs; `rethrow` afterwards raises a caught exception.
#pragma once

#include "convert.hpp"

#include <chrono>
#include <exception>
#include <functional>

namespace restage::python {

class Pulse {
  public:
    // `ask` is called with the GIL; false = stop. An exception in it also stops. Empty: only Ctrl-C is checked.
    // `at_once`: called the first time without a wait, so that work of any length can be stopped.
    explicit Pulse(std::function<bool()> ask = {}, bool at_once = false) : ask_(std::move(ask)) {
        if (at_once) last_ -= interval;
    }

    bool keep_going() { // any thread, one at a time; cheap: Python is called 20 times a second
        if (stopped_) return false;
        const auto now = std::chrono::steady_clock::now();
        if (now - last_ < interval) return true;
        return ask();
    }
    bool ask() {
        const nb::gil_scoped_acquire gil;
        try {
            if (PyErr_CheckSignals() != 0) nb::raise_python_error();
            if (ask_ && !ask_()) stopped_ = true;
        } catch (...) {
            error_ = std::current_exception();
            stopped_ = true;
        }
        last_ = std::chrono::steady_clock::now();
        return !stopped_;
    }
    bool stopped() const { return stopped_; }
    void rethrow() { // [GIL]
        if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
    }

  private:
    static constexpr std::chrono::milliseconds interval{50};
    std::function<bool()> ask_;
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
    std::exception_ptr error_;
    bool stopped_ = false;
};

// A Python callback's result: None continues, False stops.
inline bool goes_on(const nb::object& answer) { return answer.is_none() || nb::cast<bool>(nb::bool_(answer)); }

} // namespace restage::python

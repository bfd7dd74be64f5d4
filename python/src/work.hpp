// SPDX-License-Identifier: Apache-2.0
// Runs plugins for a script: without the GIL, stopped by Ctrl-C or by the script's callback.
#pragma once

#include "host.hpp"
#include "pulse.hpp"

#include <shared_mutex>
#include <string>
#include <string_view>

namespace restage::python {

// f(io::Progress) without the GIL, with the plugins held; Ctrl-C and the callback (fraction, what) -> bool stop it.
template <class F>
auto work(Host& host, const nb::object& callback, F&& f) {
    float fraction = 0;
    std::string what;
    Pulse pulse([&]() -> bool { return callback.is_none() || goes_on(callback(fraction, what)); }, true);
    auto result = [&] {
        const nb::gil_scoped_release release;
        const std::shared_lock plugins(host.in_use());
        return f([&](float done, std::string_view text) {
            fraction = done;
            what = text;
            return pulse.keep_going();
        });
    }();
    pulse.rethrow();
    host.flush_log();
    return take(std::move(result));
}

} // namespace restage::python

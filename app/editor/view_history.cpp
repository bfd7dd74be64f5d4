// SPDX-License-Identifier: Apache-2.0
#include "view_history.hpp"

namespace restage::editor {

namespace {

constexpr std::size_t most = 200; // entries

} // namespace

void ViewHistory::go(const Place& to, std::string_view gesture) {
    if (to == now()) return;
    ++version_;
    if (!gesture.empty() && gesture == gesture_) {
        places_[at_] = to;
        return;
    }
    gesture_ = gesture;
    places_.resize(at_ + 1);
    places_.push_back(to);
    if (places_.size() > most) places_.erase(places_.begin());
    at_ = places_.size() - 1;
}

void ViewHistory::back() {
    end_gesture();
    if (!can_back()) return;
    --at_;
    ++version_;
}

void ViewHistory::forward() {
    end_gesture();
    if (!can_forward()) return;
    ++at_;
    ++version_;
}

} // namespace restage::editor

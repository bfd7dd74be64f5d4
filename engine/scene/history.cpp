// SPDX-License-Identifier: Apache-2.0
#include "scene/history.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <unordered_map>

namespace restage::scene {

namespace {

// Of what a change is: its type and, where there are many of that, its id.
std::uint64_t target(const AnyChange& change) {
    const std::uint32_t id = std::visit(
        []<class C>(const C& c) -> std::uint32_t {
            if constexpr (requires { c.id; })
                return c.id.value;
            else
                return 0;
        },
        change);
    return std::uint64_t(change.index()) << 32 | id;
}

void drop_idle_changes(Edit& edit) {
    std::erase_if(edit.changes, [](const AnyChange& change) {
        return std::visit([](const auto& c) { return c.before == c.after; }, change);
    });
}

// `later` happened after `edit`: each target keeps its first `before` and gets the last `after`. Changes of different
// targets commute, and an insert stays where it was first.
void merge(Edit& edit, const Edit& later) {
    std::unordered_map<std::uint64_t, std::size_t> place;
    place.reserve(edit.changes.size());
    for (std::size_t i = 0; i < edit.changes.size(); ++i)
        place.emplace(target(edit.changes[i]), i);
    for (const AnyChange& change : later.changes) {
        const auto [found, is_new] = place.emplace(target(change), edit.changes.size());
        if (is_new)
            edit.changes.push_back(change);
        else
            std::visit([&]<class C>(const C& c) { std::get<C>(edit.changes[found->second]).after = c.after; }, change);
    }
    drop_idle_changes(edit);
}

} // namespace

bool History::push(Scene& scene, Edit edit, std::string_view gesture) {
    drop_idle_changes(edit);
    if (edit.changes.empty()) return false;
    apply(scene, edit);
    if (!gesture.empty() && gesture == gesture_ && position_ > 0) {
        merge(edits_.back(), edit);
        if (edits_.back().changes.empty()) { // dragged back to where it began
            edits_.pop_back();
            --position_;
            end_gesture();
        }
        return true;
    }
    end_gesture();
    if (!gesture.empty()) {
        redo_before_.assign(std::make_move_iterator(edits_.begin() + std::ptrdiff_t(position_)),
                            std::make_move_iterator(edits_.end()));
        clean_before_ = clean_;
    }
    edits_.resize(position_);
    if (clean_ && *clean_ > position_) clean_.reset();
    edits_.push_back(std::move(edit));
    ++position_;
    gesture_ = gesture;
    return true;
}

void History::end_gesture() {
    gesture_.clear();
    redo_before_.clear();
}

bool History::cancel_gesture(Scene& scene) {
    if (gesture_.empty() || position_ == 0) return false;
    apply(scene, inverse(edits_[position_ - 1]));
    edits_.resize(--position_);
    std::ranges::move(redo_before_, std::back_inserter(edits_)); // comes back, and so does the saved state
    clean_ = clean_before_;
    end_gesture();
    return true;
}

bool History::undo(Scene& scene) {
    end_gesture();
    if (position_ == 0) return false;
    apply(scene, inverse(edits_[--position_]));
    return true;
}

bool History::redo(Scene& scene) {
    end_gesture();
    if (position_ == edits_.size()) return false;
    apply(scene, edits_[position_++]);
    return true;
}

void History::mark_clean() {
    clean_ = position_;
    end_gesture();
}

} // namespace restage::scene

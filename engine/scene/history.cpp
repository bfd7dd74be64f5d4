// SPDX-License-Identifier: Apache-2.0
#include "scene/history.hpp"

#include <algorithm>

namespace restage::scene {

namespace {

template <class T>
bool same_target(const Change<T>& a, const Change<T>& b) {
    return a.id == b.id;
}
template <class T>
bool same_target(const ChangeOne<T>&, const ChangeOne<T>&) {
    return true;
}

void drop_idle_changes(Edit& edit) {
    std::erase_if(edit.changes, [](const AnyChange& change) {
        return std::visit([](const auto& c) { return c.before == c.after; }, change);
    });
}

// `later` happened after `edit`: each target keeps its first `before` and gets the last `after`. Changes of different
// targets commute, and an insert stays where it was first.
void merge(Edit& edit, const Edit& later) {
    for (const AnyChange& change : later.changes)
        std::visit(
            [&]<class C>(const C& c) {
                for (AnyChange& earlier : edit.changes)
                    if (auto* e = std::get_if<C>(&earlier); e && same_target(*e, c)) {
                        e->after = c.after;
                        return;
                    }
                edit.changes.push_back(c);
            },
            change);
    drop_idle_changes(edit);
}

} // namespace

bool History::push(Scene& scene, Edit edit, std::string_view gesture) {
    drop_idle_changes(edit);
    if (edit.changes.empty()) return false;
    apply(scene, edit);
    const bool merges = !gesture.empty() && gesture == gesture_ && position_ > 0;
    edits_.resize(position_);
    if (clean_ && *clean_ > position_) clean_.reset();
    if (merges) {
        merge(edits_.back(), edit);
        if (edits_.back().changes.empty()) { // dragged back to where it began
            edits_.pop_back();
            --position_;
            gesture_.clear();
        }
        return true;
    }
    edits_.push_back(std::move(edit));
    ++position_;
    gesture_ = gesture;
    return true;
}

bool History::undo(Scene& scene) {
    gesture_.clear();
    if (position_ == 0) return false;
    apply(scene, inverse(edits_[--position_]));
    return true;
}

bool History::redo(Scene& scene) {
    gesture_.clear();
    if (position_ == edits_.size()) return false;
    apply(scene, edits_[position_++]);
    return true;
}

void History::mark_clean() {
    clean_ = position_;
    gesture_.clear();
}

} // namespace restage::scene

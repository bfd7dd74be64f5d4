// SPDX-License-Identifier: Apache-2.0
// History: the edits of a document in order, and the scene's position among them. A gesture (a drag, a slider) is one
// entry: pushes with the same key are merged until the gesture ends. Memory is bounded: beyond a budget of
// bytes the oldest edits are dropped and can no longer be undone.
#pragma once

#include "scene/edit.hpp"

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace restage::scene {

class History {
  public:
    static constexpr std::size_t default_budget = std::size_t{512} << 20; // [bytes]
    History() = default;
    explicit History(std::size_t budget) : budget_(budget) {}

    // Applies the edit and records it; clears redo. An edit that changes nothing is not recorded.
    // `gesture`: if not empty, merge with the entry of the same running gesture. True if the scene changed.
    bool push(Scene&, Edit edit, std::string_view gesture = {});
    // Likewise for an edit, perhaps an empty one, that also replaces what the document holds beside the scene: a value
    // that never changes, for example its looks. Its memory does not count.
    using Beside = std::shared_ptr<const void>;
    void push_beside(Scene&, Edit edit, Beside beside);
    const Beside& beside() const { return beside_; } // at this position
    void begin_beside(Beside beside) { beside_ = std::move(beside); } // of a document just opened
    void end_gesture();
    // Reverts the running gesture and forgets it: position, entries and redo are as they
    // were before it began. True if the scene changed.
    bool cancel_gesture(Scene&);

    bool undo(Scene&); // false = nothing to undo
    bool redo(Scene&);

    std::size_t size() const { return entries_.size(); }
    std::size_t position() const { return position_; } // number of edits applied
    const std::string& label(std::size_t i) const { return entries_[i].edit.label; }
    std::string_view undo_label() const { return position_ ? std::string_view(label(position_ - 1)) : ""; }
    std::string_view redo_label() const { return position_ < size() ? std::string_view(label(position_)) : ""; }

    // An estimate [bytes]: items before and after, and geometry and pixels held only by the history.
    std::size_t bytes() const;
    std::size_t budget() const { return budget_; }
    void set_budget(std::size_t bytes); // the newest applied edit stays, however large it is
    std::size_t dropped() const { return dropped_; } // number of edits dropped to meet the budget

    void mark_clean(); // the current scene equals the file
    std::optional<std::size_t> clean_position() const { return clean_; } // of the saved state, while reachable
    void mark_unsaved() { clean_.reset(); } // no position equals the file
    bool clean() const { return clean_ && *clean_ == position_; }

  private:
    struct Shared { // mesh or pixel data
        std::weak_ptr<const void> data;
        std::size_t bytes = 0;
        long holders = 0; // in the entries
    };
    struct Entry {
        Edit edit;
        std::size_t bytes = 0; // without shared data
        bool replaces = false; // what is beside the scene
        Beside before = nullptr, after = nullptr;
    };
    Entry hold(Edit);
    void count_shared(const Edit&, int sign);
    void forget(std::vector<Entry>::iterator first, std::vector<Entry>::iterator last); // in entries_
    void hold_to_budget();
    void append(Entry);

    std::vector<Entry> entries_;
    std::size_t position_ = 0;
    std::optional<std::size_t> clean_ = 0; // position of the saved state; nullopt = unreachable
    std::string gesture_; // key of the running gesture; its entry is entries_[position_ - 1]
    std::vector<Entry> redo_before_; // redo entries from when the running gesture began
    std::optional<std::size_t> clean_before_; // likewise clean_
    Beside beside_;
    std::map<const void*, Shared> shared_;
    std::size_t budget_ = default_budget, own_bytes_ = 0, dropped_ = 0; // own_bytes_: of all entries, and redo_before_
};

} // namespace restage::scene

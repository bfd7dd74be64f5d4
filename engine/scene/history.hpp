// SPDX-License-Identifier: Apache-2.0
// History: the edits of a document in order, and where in them the scene stands. A gesture (a drag, a slider) is one
// entry: pushes with the same key are merged until the gesture ends.
#pragma once

#include "scene/edit.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace restage::scene {

class History {
  public:
    // Applies the edit and records it; what could be redone is gone. An edit that changes nothing is not recorded.
    // `gesture`: not empty = merge with the entry of the same running gesture. True when the scene changed.
    bool push(Scene&, Edit edit, std::string_view gesture = {});
    void end_gesture();
    // Takes back what the running gesture did and forgets it: position, entries and what could be redone are as they
    // were before it began. True when the scene changed.
    bool cancel_gesture(Scene&);

    bool undo(Scene&); // false = nothing to undo
    bool redo(Scene&);

    std::size_t size() const { return edits_.size(); }
    std::size_t position() const { return position_; } // so many edits are applied
    const std::string& label(std::size_t i) const { return edits_[i].label; }
    std::string_view undo_label() const { return position_ ? std::string_view(label(position_ - 1)) : ""; }
    std::string_view redo_label() const { return position_ < size() ? std::string_view(label(position_)) : ""; }

    void mark_clean(); // the scene as it is now is what the file holds
    std::optional<std::size_t> clean_position() const { return clean_; } // of the saved state, while it can be reached
    void mark_unsaved() { clean_.reset(); } // no position is what the file holds
    bool clean() const { return clean_ && *clean_ == position_; }

  private:
    std::vector<Edit> edits_;
    std::size_t position_ = 0;
    std::optional<std::size_t> clean_ = 0; // position of the saved state; none = it cannot be reached any more
    std::string gesture_; // key of the running gesture; its entry is edits_[position_ - 1]
    std::vector<Edit> redo_before_; // what could be redone when the running gesture began
    std::optional<std::size_t> clean_before_; // the same of clean_
};

} // namespace restage::scene

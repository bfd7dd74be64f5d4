// SPDX-License-Identifier: Apache-2.0
// ViewHistory: earlier viewpoints, to step back and forth through. Navigation does not change the document: the scene's
// camera stays in place, and the view returns to it when the camera itself is moved.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace restage::editor {

class ViewHistory {
  public:
    using Place = std::optional<glm::dmat4>; // camera to world; none = the scene's camera

    const Place& now() const { return places_[at_]; }
    // All steps of a gesture are one entry.
    void go(const Place& to, std::string_view gesture = {});
    void end_gesture() { gesture_.clear(); }
    bool can_back() const { return at_ > 0; }
    bool can_forward() const { return at_ + 1 < places_.size(); }
    void back();
    void forward();
    std::uint64_t version() const { return version_; } // grows with every change of now()

  private:
    std::vector<Place> places_{std::nullopt};
    std::size_t at_ = 0;
    std::string gesture_;
    std::uint64_t version_ = 0;
};

} // namespace restage::editor

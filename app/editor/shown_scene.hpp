// SPDX-License-Identifier: Apache-2.0
// ShownScene: what the live picture shows: the document, with a change that is only tried out (a material under the
// mouse). Trying and dropping it leaves the document as it is, history and versions included, yet the renderer
// must see a sequence of changes: this keeps a copy whose versions grow with each of them.
#pragma once

#include "base/result.hpp"
#include "scene/edit.hpp"

#include <cstdint>
#include <functional>
#include <optional>

namespace restage::editor {

struct Trial { // a change to show without making it
    std::uint64_t number = 0; // another number = another change
    std::function<Result<scene::Edit>(const scene::Scene&)> build; // null = none
};

class ShownScene {
  public:
    // The document's scene, with the trial. `document` as in DocumentContext. Costs what has changed since the last
    // call; until the first trial, the document's scene itself. An edit that cannot be built shows the document.
    const scene::Scene& follow(const scene::Scene& scene, std::uint64_t document, const Trial& trial);
    bool trying() const { return undo_.has_value(); }

  private:
    std::optional<scene::Scene> shown_; // once there was a trial
    scene::Version seen_ = 0; // clock of the document that shown_ follows
    std::uint64_t document_ = 0, trial_ = 0;
    std::optional<scene::Edit> undo_; // of the trial in shown_
};

} // namespace restage::editor

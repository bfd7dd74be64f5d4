// SPDX-License-Identifier: Apache-2.0
// The host's side of restage/action.h: an action writes into a copy of the scene it reads (copy-on-write, so the cost
// is that of the changes), through the same writer as importers and the builders of scene/edits.hpp. The edit is the
// difference of the two. Invalid changes are refused with a line in the report.
#pragma once

#include "io/scene_writer.hpp"
#include "scene/edits.hpp"

#include <restage/action.h>
#include <cstdint>
#include <string>
#include <vector>

namespace restage::io {

// `base` and `registry` must outlive it.
class EditWriter final : public SceneWriter {
  public:
    EditWriter(const scene::Scene& base, const plugin::Registry&, Progress);

    RestageEditWriter1& edits() { return edits_; } // its ctx is this writer

    // The changes as one validated edit. Call once, after run. Reads images.
    Result<scene::Edit> finish(Jobs&, std::string label);
    // The objects that the action selected, else its new objects.
    std::vector<scene::Id<scene::Instance>> selection() const;
    std::uint64_t late() const; // changes after progress() returned 0

  private:
    struct EditCalls; // the C functions
    // Applies the edit to the copy; 0 and a report line about `what` if it was refused.
    int take(const std::string& what, Result<scene::Edit>);
    template <class T>
    std::string called(scene::Id<T>) const;

    const scene::Scene& base_;
    RestageEditWriter1 edits_{};
    std::vector<scene::Id<scene::Instance>> chosen_;
    std::uint64_t changes() const;
    std::uint64_t stopped_at_ = 0; // changes() + 1 when progress() first returned 0; 0 = not yet
};

} // namespace restage::io

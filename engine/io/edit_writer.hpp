// SPDX-License-Identifier: Apache-2.0
// The host's side of restage/action.h: an action writes into a copy of the scene it reads (copied on write, so that
// costs what it changes), through the writer that importers have and the builders of scene/edits.hpp. The edit is the
// difference of the two. What cannot be done is refused with a line in the report.
#pragma once

#include "io/scene_writer.hpp"
#include "scene/edits.hpp"

#include <restage/action.h>
#include <cstdint>
#include <string>
#include <vector>

namespace restage::io {

// `base` and `registry` outlive it.
class EditWriter final : public SceneWriter {
  public:
    EditWriter(const scene::Scene& base, const plugin::Registry&, Progress);

    RestageEditWriter1& edits() { return edits_; } // its ctx is this writer

    // What was changed, as one edit; validated. Call once, after run. Images are read.
    Result<scene::Edit> finish(Jobs&, std::string label);
    // What the action has chosen, else its new objects.
    std::vector<scene::Id<scene::Instance>> selection() const;
    std::uint64_t late() const; // changes after progress() had said stop

  private:
    struct EditCalls; // the C functions
    // Makes the edit in the copy; 0 and a line of the report about `what` where there is none.
    int take(const std::string& what, Result<scene::Edit>);
    template <class T>
    std::string called(scene::Id<T>) const;

    const scene::Scene& base_;
    RestageEditWriter1 edits_{};
    std::vector<scene::Id<scene::Instance>> chosen_;
    std::uint64_t changes() const;
    std::uint64_t stopped_at_ = 0; // changes() when progress() said stop, and 1; 0 = it has not
};

} // namespace restage::io

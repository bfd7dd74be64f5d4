// SPDX-License-Identifier: Apache-2.0
// Selection: the user's current selection. Not part of the document, its history or any file. The parts of a thing and
// the objects in a group are selected together until the thing or the group is entered.
#pragma once

#include "query/wholes.hpp"
#include "scene/bounds.hpp"
#include "scene/scene.hpp"

#include <span>
#include <unordered_set>
#include <vector>

namespace restage::editor {

using InstanceId = scene::Id<scene::Instance>;
using GroupId = scene::Id<scene::Group>;
using query::instances_in;
using query::Whole;

class Selection {
  public:
    // In the order of selection; the last one is the active one, whose values panels show.
    const std::vector<InstanceId>& instances() const { return instances_; }
    bool empty() const { return instances_.empty() && !light_; }
    bool contains(InstanceId id) const { return members_.contains(id); }
    InstanceId active() const { return instances_.empty() ? InstanceId{} : instances_.back(); }
    // A light without a surface; selecting one deselects the objects.
    scene::Id<scene::Light> light() const { return light_; }
    // Picks select what is within this, wholes elsewhere.
    Whole entered() const { return entered_; }

    enum class Mode { replace, add, toggle };
    void set(std::span<const InstanceId> ids, Mode mode = Mode::replace);
    void set_light(scene::Id<scene::Light> light);
    void clear();
    void enter(Whole whole) { entered_ = whole; }
    // Forgets what no longer exists (after undo, delete).
    void prune(const scene::Scene& scene);

    // What a click on the object selects; it is the last one, and so the active one.
    std::vector<InstanceId> click_target(const scene::Scene& scene, InstanceId id) const;
    // The outermost whole around the object inside the entered one; none if a click selects the object itself.
    Whole click_whole(const scene::Scene& scene, InstanceId id) const;
    // Likewise, but of groups only.
    GroupId click_group(const scene::Scene& scene, InstanceId id) const;
    // The wholes around the object, from the outside in, that count at present.
    std::vector<Whole> wholes(const scene::Scene& scene, InstanceId id) const;

    query::Things things; // of the document, once they are found (finding_things.hpp)
    bool whole_things = true; // a click takes them

    scene::Bounds bounds(const scene::Scene& scene) const;

  private:
    std::vector<InstanceId> instances_;
    std::unordered_set<InstanceId> members_; // the same
    scene::Id<scene::Light> light_;
    Whole entered_;
};

} // namespace restage::editor

// SPDX-License-Identifier: Apache-2.0
// Selection: the user's current selection. Not part of the document, its history or any file. Objects in a group are
// selected together until the group is entered.
#pragma once

#include "scene/bounds.hpp"
#include "scene/scene.hpp"

#include <span>
#include <unordered_set>
#include <vector>

namespace restage::editor {

using InstanceId = scene::Id<scene::Instance>;
using GroupId = scene::Id<scene::Group>;

class Selection {
  public:
    // In the order of selection; the last one is the active one, whose values panels show.
    const std::vector<InstanceId>& instances() const { return instances_; }
    bool empty() const { return instances_.empty() && !light_; }
    bool contains(InstanceId id) const { return members_.contains(id); }
    InstanceId active() const { return instances_.empty() ? InstanceId{} : instances_.back(); }
    // A light without a surface; selecting one deselects the objects.
    scene::Id<scene::Light> light() const { return light_; }
    // Picks select single objects within this group, whole groups elsewhere.
    GroupId entered() const { return entered_; }

    enum class Mode { replace, add, toggle };
    void set(std::span<const InstanceId> ids, Mode mode = Mode::replace);
    void set_light(scene::Id<scene::Light> light);
    void clear();
    void enter(GroupId group) { entered_ = group; }
    // Forgets what no longer exists (after undo, delete).
    void prune(const scene::Scene& scene);

    // The things selected by a click on `id`: the object itself, or all of its outermost group that is not entered.
    std::vector<InstanceId> click_target(const scene::Scene& scene, InstanceId id) const;
    // The outermost group around the object inside the entered one; none if a click selects the object itself.
    GroupId click_group(const scene::Scene& scene, InstanceId id) const;

    scene::Bounds bounds(const scene::Scene& scene) const;

  private:
    std::vector<InstanceId> instances_;
    std::unordered_set<InstanceId> members_; // the same
    scene::Id<scene::Light> light_;
    GroupId entered_;
};

// All objects in a group and the groups within it.
std::vector<InstanceId> instances_in(const scene::Scene& scene, GroupId group);
bool is_within(const scene::Scene& scene, GroupId inner, GroupId outer);

} // namespace restage::editor

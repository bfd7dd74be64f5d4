// SPDX-License-Identifier: Apache-2.0
// Snapping: where a thing that is dragged comes to rest: on a grid, with a corner on a corner, standing on the surface
// under the mouse, against a wall. Correct for what is near only; nothing here says that other parts do not enter
// things.
#pragma once

#include "query/navigation.hpp"
#include "scene/bounds.hpp"
#include "scene/scene.hpp"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

namespace restage::query {

struct SnapTo {
    bool grid = false, vertex = false, surface = false, wall = false;
};

struct SnapHint { // what it snapped to
    enum class Kind { grid, vertex, surface, wall } kind = Kind::grid;
    glm::dvec3 at{0}; // the touched place
    glm::dvec3 along{0}; // of a wall: its horizontal direction, unit
    std::string name; // of the object touched; "" = the grid
};

class Snapping {
  public:
    // A thing: meshes of these objects at their places before the drag. `skip`: objects not to snap to. `grabbed`:
    // where it is held, `mouse`: the ray then. `up`: unit, an axis of the world.
    Snapping(const scene::Scene&, std::span<const std::pair<scene::Id<scene::Instance>, glm::dmat4>> thing,
             std::unordered_set<scene::Id<scene::Instance>> skip, const glm::dvec3& grabbed, const ViewRay& mouse,
             const glm::dvec3& up);

    struct Drag {
        glm::dvec3 by{0}; // where it would be without snapping
        ViewRay mouse;
        std::optional<glm::dvec3> axis; // it is dragged along: unit. Then only grid and wall, along it
        double radius = 0; // from which corners and walls attract [heights of the film]
        double grid = 1; // > 0
    };
    struct Snapped {
        glm::dvec3 by{0};
        std::vector<SnapHint> hints; // empty: it is where it would be
    };
    Snapped snap(const scene::Scene&, const scene::Camera&, double aspect, const SnapTo&, const Drag&) const;

  private:
    using Skip = std::function<bool(scene::Id<scene::Instance>)>;
    std::optional<Snapped> to_vertex(const scene::Scene&, const scene::Camera&, double aspect, const Drag&) const;
    std::optional<Snapped> to_surface(const scene::Scene&, const Drag&) const;
    void to_wall(const scene::Scene&, double reach, const std::optional<glm::dvec3>& axis, Snapped&) const;
    glm::dvec3 flat(const glm::dvec3& v) const { return v - up_ * glm::dot(v, up_); }

    glm::dvec3 up_, base_{0}; // the middle of the underside
    std::optional<glm::dvec3> corner_; // nearest to where it is held
    std::optional<glm::dvec3> below_; // the mouse on the plane of the underside, at the start
    scene::Bounds box_;
    std::vector<glm::dvec3> points_; // all corners
    Skip skip_;
};

} // namespace restage::query

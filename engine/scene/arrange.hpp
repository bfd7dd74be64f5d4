// SPDX-License-Identifier: Apache-2.0
// Arranging whole things: builders of edits, like edits.hpp, that align, distribute, mirror, repeat and replace them. A
// thing is one or several objects that keep their places relative to each other: a chair of twenty meshes. Boxes are
// those of scene/bounds.hpp; lengths in scene units, angles in degrees, axes 0 to 2 of the world.
#pragma once

#include "scene/bounds.hpp"
#include "scene/edits.hpp"

#include <span>
#include <vector>

namespace restage::scene {

using Thing = std::vector<Id<Instance>>;
using Things = std::span<const Thing>;

Bounds world_bounds(const Scene&, std::span<const Id<Instance>>); // of all of them; empty without geometry

enum class Side : std::uint8_t { lower, center, upper }; // of a box, along an axis

// Moves each thing along the axis, so that this side of its box is where the target's is. Things without geometry stay.
Result<Edit> align(const Scene&, Things, int axis, Side, const Bounds& target);

enum class Spacing : std::uint8_t { gaps, centers };
// Moves the things between the two outermost ones (by their centres), which stay, so that the gaps between boxes, or
// the distances of centres, are equal. An error for less than three things with geometry.
Result<Edit> distribute(const Scene&, Things, int axis, Spacing);

// The reflection that maps each point to its mirror image behind the plane through `at`, perpendicular to the axis.
glm::dmat4 reflection(int axis, double at);
// In place: shapes are mirrored, and what was outside of them stays outside (a normal is transformed by the inverse
// transpose, whatever the determinant's sign). A mirrored copy: duplicate_each with the reflection.
Result<Edit> mirror(const Scene&, std::span<const Id<Instance>>, int axis, double at);
Result<Edit> mirror(const Scene&, Id<Light>, int axis, double at);

// One set of copies for each displacement, as by duplicate_instances: `copies` are those of the first one, then of the
// next. An error for no objects, or more than `most_copies`.
constexpr std::size_t most_copies = 100'000;
Result<Duplicate> duplicate_each(const Scene&, std::span<const Id<Instance>>, std::span<const glm::dmat4> moves);

// Displacements of the copies of an array, without the original's place. Counts include the original, and are at
// least 1.
std::vector<glm::dmat4> line_array(int count, const glm::dvec3& step);
std::vector<glm::dmat4> grid_array(const glm::ivec3& count, const glm::dvec3& spacing);
struct Circle {
    int count = 6;
    glm::dvec3 center{0}, axis{0, 1, 0}; // any length but 0
    double angle = 360; // from the first to the last; a full turn: the last one is a step before the first
    bool turn = true; // copies turn with it; else they keep their direction
};
// `middle`: the thing's, which stays on the circle.
std::vector<glm::dmat4> circle_array(const Circle&, const glm::dvec3& middle);

struct ReplaceOptions {
    glm::dvec3 up{0, 1, 0}; // an axis of the world
    bool keep_size = false; // of the replacement; else it is scaled uniformly to fit into the box of what it replaces
    bool turn = true; // about `up`, by the angle between their object spaces
};
// Removes the things and puts copies of `by` in their places: the centre of its underside on theirs. `copies` are in
// the order of the things. An error if `by` is one of them, or has no geometry.
Result<Duplicate> replace(const Scene&, Things, std::span<const Id<Instance>> by, const ReplaceOptions&);

} // namespace restage::scene

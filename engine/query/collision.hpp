// SPDX-License-Identifier: Apache-2.0
// Collision: how far a thing can be moved, without turning or scaling, until its surface meets another one. Exact for
// triangles, so a cup goes into an open box, and walls without thickness stop it. Spheres and other quadrics are what
// their triangles are. Nothing tips over or falls by itself.
#pragma once

#include "scene/scene.hpp"

#include <memory>
#include <optional>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

namespace restage::query {

class Collision {
  public:
    using InstanceId = scene::Id<scene::Instance>;

    struct Part {
        std::shared_ptr<const scene::MeshData> mesh;
        glm::dmat4 place; // object to world
    };
    using Thing = std::vector<Part>;
    static Thing thing_of(const scene::Scene&, std::span<const std::pair<InstanceId, glm::dmat4>> places);
    static Thing thing_of(const scene::Scene&, std::span<const InstanceId>); // where they are

    // It collides with all visible objects, except those of `skip`; they are copied, so the scene may change
    // afterwards. `up`: unit.
    //
    // What it touches or enters at the start does not hold it: for that it counts as moved out, by up to a tenth of its
    // size, so that it can slide along, but not go deeper. What it enters deeper than that does not count until it has
    // been left.
    Collision(const scene::Scene&, const Thing& thing, const std::unordered_set<InstanceId>& skip,
              const glm::dvec3& up);
    ~Collision();
    Collision(const Collision&) = delete;
    Collision& operator=(const Collision&) = delete;

    const glm::dvec3& at() const; // its displacement since the construction [world space]

    // Moves it from where it is towards the displacement `to`, as far as it goes. Between it and what stopped it
    // remains less than 1e-6 of its size. Returns what it met.
    std::vector<InstanceId> stop(const glm::dvec3& to);
    // Likewise, but it slides along what it meets: as if surfaces steeper than 45 degrees were upright, so it does not
    // climb them.
    std::vector<InstanceId> slide(const glm::dvec3& to);
    // Puts it there if it enters nothing.
    bool place(const glm::dvec3& to);
    // Puts it there in any case; what it then enters is treated as at the start.
    void force(const glm::dvec3& to);
    // For what appears in a scene: if it enters something deeper than contact, it is moved towards the viewer until it
    // fits, and from there back as near as it comes, so it ends beside that, or on it. Returns its displacement.
    glm::dvec3 make_room(const glm::dvec3& viewer);
    // How far it can be moved against `up` from there until it touches something; less than 0 if it is sunk in.
    // nullopt: nothing is below.
    std::optional<double> fall() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace restage::query

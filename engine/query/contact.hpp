// SPDX-License-Identifier: Apache-2.0
// Contact: where the surfaces of two objects come close. Surfaces are sampled, and the samples of one object are looked
// up in a hierarchy of the other's triangles.
#pragma once

#include "scene/bounds.hpp"
#include "scene/scene.hpp"

#include <memory>
#include <vector>

namespace restage::query {

class Contacts {
  public:
    explicit Contacts(const scene::Scene& scene); // which must outlive it
    ~Contacts();
    Contacts(const Contacts&) = delete;
    Contacts& operator=(const Contacts&) = delete;

    // Points on the object's surface in world space, spread evenly over its area; the same for equal scenes. Empty
    // without geometry.
    const std::vector<glm::dvec3>& points(scene::Id<scene::Instance>);
    // Whether the object's surface comes within `radius` of the point. [world space]
    bool near(scene::Id<scene::Instance>, const glm::dvec3& point, double radius);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace restage::query

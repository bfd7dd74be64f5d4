// SPDX-License-Identifier: Apache-2.0
// Box projection: texture coordinates for meshes that have none, or unsuitable ones. Each triangle takes them from its
// corners' places, seen along the axis that its normal is nearest to; they are written into the mesh, so that every
// renderer and file format has them. Where triangles seen along different axes meet, the picture has a seam.
#pragma once

#include "scene/edits.hpp"

#include <memory>
#include <span>

namespace restage::scene {

// A copy of the mesh with such uv: the coordinates of its corners after `to_space`, divided by `size` (> 0). Vertices
// are split where the axis changes; normals and second uv are kept, tangents are left out. On the sides of a box whose
// up is +y or +z, v is up; seen from outside, u goes to the right.
MeshData box_projected(const MeshData&, const glm::dmat4& to_space, double size, const glm::dvec3& up);

struct BoxOptions {
    double size = 1; // of one repetition of a texture [scene units]
    bool world_axes = false; // else each object's own; lengths are those of the world either way
    glm::dvec3 up{0, 1, 0}; // an axis of the world
};
// Gives the objects such texture coordinates: those that share a mesh and get equal ones share the new one, others keep
// theirs. Second coordinates stay. An error without a mesh with triangles, and for spheres, disks and cylinders, whose
// coordinates are fixed.
Result<Edit> project_box(const Scene&, std::span<const Id<Instance>>, const BoxOptions&);

// The size of a repetition with which a texture covers the largest of the objects once; 1 if they have no size.
double covering_size(const Scene&, std::span<const Id<Instance>>);

// Whether its textures have coordinates: a mesh with uv, or a sphere, disk or cylinder. On others each triangle shows
// the whole texture.
bool has_uv(const Mesh&);

// The visible objects with this material whose mesh has none.
std::vector<Id<Instance>> without_uv(const Scene&, Id<Material>);

} // namespace restage::scene

// SPDX-License-Identifier: Apache-2.0
// Tangent frames of normal maps for meshes whose file has none.
#pragma once

#include "common/mesh.hpp"

#include <vector>

namespace restage::importing {

// Fills mesh.tangents from the texture coordinates of the normal map, `uv`, 2 per vertex with v upwards, by the rules
// of MikkTSpace (Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited", and its accompanying code): tangents of
// triangles, weighted by the angle of the corner, are averaged over the corners that share position, normal and uv and
// are connected by edges, mirrored and unmirrored ones apart. Vertices in which several such groups meet are split. It
// is not that library: sums are in double precision and in the order of the triangles, so the last bits differ.
void make_tangents(MeshBuffer& mesh, std::vector<float> uv);

} // namespace restage::importing

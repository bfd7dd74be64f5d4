// SPDX-License-Identifier: Apache-2.0
// Colours of vertices or faces as a picture: meshes have no vertex colours, but every material takes a texture.
#pragma once

#include "common/mesh.hpp"
#include "common/values.hpp"

#include <functional>
#include <string>

namespace restage::importing {

using CornerColor = std::function<Rgb(std::size_t triangle, std::size_t corner)>; // linear

// 2 x 2 texels per triangle, read at their centres: bilinear filtering of c0, c1, c2 and c1 + c2 - c0 is the linear
// interpolation over the triangle. The mesh shares no corners afterwards and has new uv. Returns the image; 0 and an
// unchanged mesh if there are more triangles than a picture of this kind should hold (4 million, 200 MB).
RestageHandle bake_colors(const RestageSceneWriter1&, const std::string& name, MeshBuffer&, const CornerColor&);

// Unshares corners, so that per-triangle data can be stored per vertex.
void unshare_corners(MeshBuffer&);

} // namespace restage::importing

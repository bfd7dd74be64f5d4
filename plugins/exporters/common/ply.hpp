// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <restage/scene_io.h>
#include <string>

namespace restage::exporters {

// A mesh as binary PLY with the property names that pbrt and Mitsuba read: x y z, nx ny nz, u v, vertex_indices.
std::string ply_bytes(const RestageMesh&);

} // namespace restage::exporters

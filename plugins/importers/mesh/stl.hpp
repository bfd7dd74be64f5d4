// SPDX-License-Identifier: Apache-2.0
// STL: only triangles. Binary: 80 bytes, a count, 50 bytes per facet. Ascii: solid, facet normal, outer loop,
// vertex.
#pragma once

#include "common/mesh.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace restage::mesh {

// By the size that its facet count implies; text files of exactly that size do not occur.
bool is_binary_stl(std::string_view bytes);
bool is_ascii_stl(std::string_view bytes); // the first bytes are enough

struct Stl {
    importing::MeshBuffer mesh;
    importing::Vec3 origin{}; // to be added to the positions
    std::vector<float> colors; // 3 per triangle, 0..1 (sRGB), if facets have colours (VisCAM, Magics)
    std::vector<std::string> notes; // faults of the file, and unknown parts
};

// Vertices at the same place are merged. Throws ImportError if it is broken.
Stl read_stl(std::string_view bytes);

} // namespace restage::mesh

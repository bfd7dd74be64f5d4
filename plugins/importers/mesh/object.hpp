// SPDX-License-Identifier: Apache-2.0
// The contents of a mesh file, and the objects made from them.
#pragma once

#include "common/mesh.hpp"
#include "common/options.hpp"
#include "common/ply.hpp"
#include "common/report.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace restage::mesh {

struct Content {
    importing::MeshBuffer mesh;
    importing::Vec3 origin{};               // to be added to the positions
    std::vector<float> vertex_colors;       // 3 a vertex, 0..1 (sRGB)
    std::vector<float> triangle_colors;     // 3 per triangle
    std::vector<float> corner_uvs;          // 6 per triangle
    std::vector<std::uint32_t> triangle_pictures; // 1 per triangle: index of `pictures`
    std::vector<std::string> pictures;      // names, as in the file
    std::vector<std::uint32_t> edges;       // 2 per line
    std::vector<std::string> notes;         // approximations, for the report
    std::vector<std::pair<std::string, std::string>> not_read; // what, and how much
};

// One object per picture, or one with the colours, or grey. Points or lines without faces get a thickness. Returns
// the bounds. Throws ImportError if there is nothing to show.
importing::Bounds add_objects(const RestageSceneWriter1&, importing::Report&, const std::filesystem::path&, Content,
                              const importing::Placement&);

} // namespace restage::mesh

// SPDX-License-Identifier: Apache-2.0
// PLY files (Turk 1994): ascii, binary of either byte order; polygons of any shape, triangle strips, colours, texture
// coordinates of vertices and (VCGLIB, MeshLab) of the corners of faces.
#pragma once

#include "common/matrix.hpp"
#include "common/ply_header.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace restage::importing {

struct PlyWanted {
    bool colors = false;   // also data of faces and edges; else only vertices and triangles are kept
    bool recentre = false; // coordinates too large for float precision become small ones about `origin`
};

struct PlyMesh {
    std::vector<float> positions, normals, uvs; // 3, 3 and 2 per vertex; the last two may be empty
    std::vector<std::uint32_t> indices;         // 3 per triangle, < vertex_count()
    Vec3 origin{};                              // to be added to the positions
    bool has_bent_polygons = false;             // some were not flat before triangulation

    // Empty unless the file has them and they were requested.
    std::vector<float> colors;                    // 3 per vertex, 0..1, as stored (sRGB by convention)
    std::vector<float> corner_uvs;                // 6 per triangle
    std::vector<float> triangle_colors;           // 3 per triangle
    std::vector<std::uint32_t> triangle_textures; // 1 per triangle: index of `textures`
    std::vector<std::string> textures;            // names, as in the file
    std::vector<std::uint32_t> edges;             // 2 per line, < vertex_count()
    std::map<std::string, std::size_t> not_read;  // "vertex property \"quality\"", "element \"camera\"" -> how many

    std::size_t vertex_count() const { return positions.size() / 3; }
    std::size_t triangle_count() const { return indices.size() / 3; }
};

// Every size is checked against the available bytes before memory is allocated. There may be no triangles.
// Throws PlyProblem.
PlyMesh read_ply(std::string_view bytes, const PlyWanted&);

} // namespace restage::importing

// SPDX-License-Identifier: Apache-2.0
// The contents of an OBJ file: vertices, and shapes of triangles.
#pragma once

#include "common/matrix.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace restage::obj {

using importing::Vec3;

struct Corner { // of a face; -1 = none, else within the model's arrays
    int vertex = -1, coordinate = -1, normal = -1;
};

struct Shape { // started by an `o` or `g`
    std::string name;
    std::uint32_t line = 0;
    std::vector<Corner> corners;          // 3 per triangle
    std::vector<int> materials;           // 1 per triangle: index of Model::materials, -1 = none
    std::vector<std::uint32_t> smoothing; // 1 per triangle: group, 0 = flat
};

struct Model {
    std::vector<float> vertices, coordinates, normals; // 3, 2 and 3 each; vertices about `origin`
    std::vector<float> colors;                         // 3 per vertex, 0..1 (sRGB), or empty
    Vec3 origin{};
    std::vector<Shape> shapes;                                    // none without a triangle
    std::vector<std::pair<std::string, std::uint32_t>> materials; // names of `usemtl`, and the line of the first
    std::vector<std::pair<std::string, std::uint32_t>> libraries; // the rest of each `mtllib`, and its line
    std::vector<std::uint32_t> points, lines;                     // 1 vertex per point, 2 per line
    std::map<std::string, std::pair<std::uint32_t, std::uint32_t>> skipped; // statement -> first line, how often
    std::pair<std::string, std::uint32_t> absent; // the first corner with a missing coordinate or normal, its line
    std::uint32_t absent_count = 0;
    bool has_bent_polygons = false;
};

// goes_on(0..1) is called regularly; false stops it (Cancelled). Malformed input is an ImportError with its place:
// a vertex that is not three finite numbers, a face that names a missing vertex. Missing texture coordinates and
// normals are skipped and counted.
Model read_model(std::string_view text, const std::function<bool(double)>& goes_on);

} // namespace restage::obj

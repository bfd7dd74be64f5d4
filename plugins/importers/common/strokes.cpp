// SPDX-License-Identifier: Apache-2.0
#include "common/strokes.hpp"

#include <algorithm>
#include <cmath>

namespace restage::importing {

namespace {

Vec3 at(std::span<const float> positions, std::uint32_t i) {
    const std::size_t k = 3 * std::size_t{i};
    return {positions[k], positions[k + 1], positions[k + 2]};
}

Bounds bounds_of(std::span<const float> positions, std::span<const std::uint32_t> which) {
    Bounds box;
    for (const std::uint32_t i : which)
        box.add(at(positions, i));
    return box;
}

void add_vertex(MeshBuffer& mesh, Vec3 p) {
    for (const double x : p)
        mesh.positions.push_back(static_cast<float>(x));
}

void add_triangles(MeshBuffer& mesh, std::uint32_t first, std::span<const std::uint32_t> corners) {
    for (const std::uint32_t c : corners)
        mesh.indices.push_back(first + c);
}

} // namespace

Strokes thick_points(std::span<const float> positions, std::span<const std::uint32_t> points) {
    static constexpr std::uint32_t faces[] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    Strokes result;
    result.triangles_each = 8;
    result.step = (points.size() + most_strokes - 1) / most_strokes;
    const double size = 2 * bounds_of(positions, points).radius();
    result.radius = size > 0 ? size / std::sqrt(double(points.size())) / 3 : 0.5;
    for (std::size_t k = 0; k < points.size(); k += result.step) {
        const Vec3 p = at(positions, points[k]);
        const std::uint32_t first = result.mesh.vertex_count();
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const double side : {1.0, -1.0}) {
                Vec3 q = p;
                q[axis] += side * result.radius;
                add_vertex(result.mesh, q);
            }
        add_triangles(result.mesh, first, faces);
    }
    return result;
}

Strokes thick_lines(std::span<const float> positions, std::span<const std::uint32_t> lines) {
    static constexpr std::uint32_t faces[] = {0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6,
                                              3, 0, 4, 3, 4, 7, 3, 2, 1, 3, 1, 0, 4, 5, 6, 4, 6, 7};
    Strokes result;
    result.triangles_each = 12;
    result.step = (lines.size() / 2 + most_strokes - 1) / most_strokes;
    const double size = 2 * bounds_of(positions, lines).radius();
    result.radius = size > 0 ? size / 300 : 0.5;
    for (std::size_t k = 0; k + 1 < lines.size(); k += 2 * result.step) {
        const Vec3 a = at(positions, lines[k]), b = at(positions, lines[k + 1]);
        const Vec3 along = normalized(b - a);
        const Vec3 u = normalized(cross(std::abs(along[0]) < 0.8 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, along));
        const Vec3 v = cross(along, u);
        const std::uint32_t first = result.mesh.vertex_count();
        for (const Vec3& end : {a, b})
            for (const auto& [x, y] : {std::pair(1.0, 1.0), {-1.0, 1.0}, {-1.0, -1.0}, {1.0, -1.0}})
                add_vertex(result.mesh, end + u * (x * result.radius) + v * (y * result.radius));
        add_triangles(result.mesh, first, faces);
    }
    return result;
}

} // namespace restage::importing

// SPDX-License-Identifier: Apache-2.0
#include "surface.hpp"

#include <algorithm>

namespace scatter {

Surface::Surface(const RestageMesh& mesh, const RestageInstance& instance, const SurfaceOptions& options) {
    const Affine to_world = Affine::from(instance.object_to_world);
    const auto vertex = [](const float* list, std::uint32_t i) {
        return Vec{list[3 * std::size_t{i}], list[3 * std::size_t{i} + 1], list[3 * std::size_t{i} + 2]};
    };
    // The normal of an object's triangle goes to world space by the inverse transpose, which differs from the cross
    // product of the edges there by the sign of the determinant.
    const bool reversed = (instance.flags & RESTAGE_INSTANCE_REVERSE_ORIENTATION) != 0;
    const double side = (to_world.determinant() < 0) != (reversed != options.back) ? -1 : 1;
    triangles_.reserve(mesh.triangle_count);
    areas_.reserve(mesh.triangle_count);
    double sum = 0;
    for (std::uint32_t t = 0; t < mesh.triangle_count; ++t) {
        const std::uint32_t* i = mesh.indices + 3 * std::size_t{t};
        const Vec local = cross(vertex(mesh.positions, i[1]) - vertex(mesh.positions, i[0]),
                                vertex(mesh.positions, i[2]) - vertex(mesh.positions, i[0]));
        const Vec corner = to_world.point(vertex(mesh.positions, i[0]));
        const Vec edge1 = to_world.point(vertex(mesh.positions, i[1])) - corner;
        const Vec edge2 = to_world.point(vertex(mesh.positions, i[2])) - corner;
        Vec normal = cross(edge1, edge2);
        const double twice = length(normal);
        if (!(twice > 0) || !std::isfinite(twice)) continue; // degenerate
        normal = normal * (side / twice);
        if (mesh.normals) { // they define the outside
            const Vec shading = vertex(mesh.normals, i[0]) + vertex(mesh.normals, i[1]) + vertex(mesh.normals, i[2]);
            if (dot(local, shading) < 0) normal = normal * -1;
        }
        whole_area_ += twice / 2;
        if (dot(normal, options.up) < options.least_cos) continue;
        sum += twice / 2;
        triangles_.push_back({corner, edge1, edge2, normal});
        areas_.push_back(sum);
    }
}

Spot Surface::sample(double u, double v, double w) const {
    const auto it = std::upper_bound(areas_.begin(), areas_.end(), u * area());
    const Triangle& t = triangles_[std::min<std::size_t>(std::size_t(it - areas_.begin()), triangles_.size() - 1)];
    // Uniform barycentric coordinates. G. Turk, "Generating Random Points in Triangles", Graphics Gems 1990.
    const double root = std::sqrt(v);
    return {t.corner + t.edge1 * (root * (1 - w)) + t.edge2 * (root * w), t.normal};
}

std::vector<std::uint32_t>& Disks::bucket(const Cell& cell) {
    std::uint64_t hash = 0;
    for (const std::int64_t k : {cell.x, cell.y, cell.z})
        hash = (hash ^ static_cast<std::uint64_t>(k)) * 0x9e3779b97f4a7c15u;
    return buckets_[hash >> 49]; // 15 bits
}

bool Disks::add(Vec point) {
    const auto cell = [&](double x) { return static_cast<std::int64_t>(std::floor(x / distance_)); };
    const Cell mine{cell(point.x), cell(point.y), cell(point.z)};
    for (std::int64_t x = mine.x - 1; x <= mine.x + 1; ++x)
        for (std::int64_t y = mine.y - 1; y <= mine.y + 1; ++y)
            for (std::int64_t z = mine.z - 1; z <= mine.z + 1; ++z)
                for (const std::uint32_t i : bucket({x, y, z})) {
                    const Vec apart = points_[i] - point;
                    if (dot(apart, apart) < distance_ * distance_) return false;
                }
    bucket(mine).push_back(static_cast<std::uint32_t>(points_.size()));
    points_.push_back(point);
    return true;
}

} // namespace scatter

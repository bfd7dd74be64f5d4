// SPDX-License-Identifier: Apache-2.0
#include "mesh.hpp"

#include <cmath>

namespace restage::pbrt {

std::size_t repair_normals(Mesh& mesh) {
    std::vector<char> broken(mesh.vertex_count());
    std::size_t count = 0;
    for (std::size_t i = 0; i < mesh.normals.size() / 3; ++i) {
        const float* n = mesh.normals.data() + 3 * i;
        const double squared = double(n[0]) * double(n[0]) + double(n[1]) * double(n[1]) + double(n[2]) * double(n[2]);
        if (!(squared > 1e-30) || !std::isfinite(squared)) {
            broken[i] = 1;
            ++count;
        }
    }
    if (count == 0) return 0;
    std::vector<Vec3> sums(mesh.vertex_count());
    const auto point = [&](std::uint32_t i) {
        const float* p = mesh.positions.data() + 3 * std::size_t(i);
        return Vec3{double(p[0]), double(p[1]), double(p[2])};
    };
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        const std::uint32_t* v = mesh.indices.data() + t;
        const Vec3 n = cross(point(v[1]) - point(v[0]), point(v[2]) - point(v[0])); // weighted by area
        for (int k = 0; k < 3; ++k)
            sums[v[k]] = sums[v[k]] + n;
    }
    for (std::size_t i = 0; i < broken.size(); ++i) {
        if (!broken[i]) continue;
        Vec3 n = normalize(sums[i]);
        if (!(dot(n, n) > 0.5)) n = {0, 0, 1};
        mesh.normals[3 * i] = static_cast<float>(n.x);
        mesh.normals[3 * i + 1] = static_cast<float>(n.y);
        mesh.normals[3 * i + 2] = static_cast<float>(n.z);
    }
    return count;
}

} // namespace restage::pbrt

// SPDX-License-Identifier: Apache-2.0
#include "common/baked_colors.hpp"

#include "common/textures.hpp"

#include <cmath>

namespace restage::importing {

void unshare_corners(MeshBuffer& mesh) {
    const auto spread = [&](std::vector<float>& values, std::size_t width) {
        if (values.empty()) return;
        std::vector<float> out;
        out.reserve(mesh.indices.size() * width);
        for (const std::uint32_t i : mesh.indices)
            for (std::size_t c = 0; c < width; ++c)
                out.push_back(values[i * width + c]);
        values = std::move(out);
    };
    spread(mesh.normals, 3);
    spread(mesh.uvs, 2);
    spread(mesh.positions, 3);
    for (std::uint32_t i = 0; i < mesh.indices.size(); ++i)
        mesh.indices[i] = i;
}

RestageHandle bake_colors(const RestageSceneWriter1& out, const std::string& name, MeshBuffer& mesh,
                          const CornerColor& color) {
    const std::uint32_t triangles = mesh.triangle_count();
    constexpr std::uint32_t most = 1u << 22;
    if (triangles == 0 || triangles > most) return 0;
    const auto columns = static_cast<std::uint32_t>(std::ceil(std::sqrt(double(triangles))));
    const std::uint32_t rows = (triangles + columns - 1) / columns, width = 2 * columns, height = 2 * rows;
    const RestageHandle image = add_pixels(out, name, width, height, 3, [&](std::size_t pixel, unsigned channel) {
        const std::size_t x = pixel % width, y = pixel / width, triangle = y / 2 * columns + x / 2;
        if (triangle >= triangles) return 0.0;
        const auto c = [&](std::size_t corner) { return color(triangle, corner)[channel]; };
        const std::size_t texel = x % 2 + 2 * (y % 2);
        return texel < 3 ? c(texel) : c(1) + c(2) - c(0);
    });
    if (!image) return 0;
    unshare_corners(mesh);
    mesh.uvs.clear();
    for (std::uint32_t t = 0; t < triangles; ++t)
        for (std::uint32_t corner = 0; corner < 3; ++corner) {
            const double x = t % columns * 2 + corner % 2 + 0.5, y = t / columns * 2 + corner / 2 + 0.5;
            mesh.uvs.push_back(static_cast<float>(x / width));
            mesh.uvs.push_back(static_cast<float>(1 - y / height)); // v upwards
        }
    return image;
}

} // namespace restage::importing

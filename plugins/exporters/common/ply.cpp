// SPDX-License-Identifier: Apache-2.0
#include "common/ply.hpp"

#include <bit>

namespace restage::exporters {

static_assert(std::endian::native == std::endian::little, "the bytes are written as they are in memory");

std::string ply_bytes(const RestageMesh& mesh) {
    std::string out = "ply\nformat binary_little_endian 1.0\ncomment written by Restage\nelement vertex " +
                      std::to_string(mesh.vertex_count) + "\nproperty float x\nproperty float y\nproperty float z\n";
    if (mesh.normals) out += "property float nx\nproperty float ny\nproperty float nz\n";
    if (mesh.uvs) out += "property float u\nproperty float v\n";
    out += "element face " + std::to_string(mesh.triangle_count) +
           "\nproperty list uchar int vertex_indices\nend_header\n";
    const std::size_t floats = 3u + (mesh.normals ? 3u : 0u) + (mesh.uvs ? 2u : 0u);
    out.reserve(out.size() + mesh.vertex_count * floats * 4 + mesh.triangle_count * std::size_t{13});
    const auto append = [&](const void* data, std::size_t bytes) { out.append(static_cast<const char*>(data), bytes); };
    for (std::size_t i = 0; i < mesh.vertex_count; ++i) {
        append(mesh.positions + 3 * i, 12);
        if (mesh.normals) append(mesh.normals + 3 * i, 12);
        if (mesh.uvs) append(mesh.uvs + 2 * i, 8);
    }
    for (std::size_t i = 0; i < mesh.triangle_count; ++i) {
        out += '\3';
        append(mesh.indices + 3 * i, 12);
    }
    return out;
}

} // namespace restage::exporters

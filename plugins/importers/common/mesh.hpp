// SPDX-License-Identifier: Apache-2.0
// The triangles of one object while an importer builds them.
#pragma once

#include "common/matrix.hpp"

#include <restage/scene_io.h>
#include <cstdint>
#include <string>
#include <vector>

namespace restage::importing {

struct MeshBuffer {
    std::vector<float> positions, normals, uvs; // 3, 3, 2 per vertex; normals and uvs may be empty
    std::vector<std::uint32_t> indices;         // 3 per triangle
    std::vector<float> tangents{}, uvs2{};      // 4 and 2 per vertex, or empty; see RestageMesh

    std::uint32_t vertex_count() const { return static_cast<std::uint32_t>(positions.size() / 3); }
    std::uint32_t triangle_count() const { return static_cast<std::uint32_t>(indices.size() / 3); }
    Vec3 position(std::size_t i) const { return {positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]}; }
    Bounds bounds() const {
        Bounds box;
        for (std::size_t i = 0; i < vertex_count(); ++i)
            box.add(position(i));
        return box;
    }
    RestageHandle push(const RestageSceneWriter1& out, const std::string& name, const std::string& source_file) const {
        const RestageMesh mesh = {.name = name.c_str(),
                                  .vertex_count = vertex_count(),
                                  .triangle_count = triangle_count(),
                                  .positions = positions.data(),
                                  .normals = normals.empty() ? nullptr : normals.data(),
                                  .uvs = uvs.empty() ? nullptr : uvs.data(),
                                  .indices = indices.data(),
                                  .source_file = source_file.c_str(),
                                  .primitive = "",
                                  .tangents = tangents.empty() ? nullptr : tangents.data(),
                                  .uvs2 = uvs2.empty() ? nullptr : uvs2.data()};
        return out.mesh(out.ctx, &mesh);
    }
};

} // namespace restage::importing

// SPDX-License-Identifier: Apache-2.0
// PLY files as in pbrt: only vertices, normals, uv and faces.
#include "common/ply.hpp"
#include "mesh.hpp"

namespace restage::pbrt {

Mesh read_ply(const std::string& path, std::string_view bytes, Location at) {
    try {
        importing::PlyMesh ply = importing::read_ply(bytes, {});
        if (ply.indices.empty()) throw importing::PlyProblem{"it has no faces"};
        return {std::move(ply.positions), std::move(ply.normals), std::move(ply.uvs), std::move(ply.indices),
                ply.has_bent_polygons};
    } catch (const importing::PlyProblem& problem) {
        throw ImportError{at, path + ": " + problem.sentence() + "; export the mesh again or remove the shape"};
    }
}

} // namespace restage::pbrt

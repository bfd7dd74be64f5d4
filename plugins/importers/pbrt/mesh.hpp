// SPDX-License-Identifier: Apache-2.0
// Triangles for the host, and the shapes that become triangles. Every shape follows pbrt's parametrisation:
// positions, normals (pbrt's, outward for a sphere), uv, and triangles wound so that cross(e1, e2) is along the
// normals.
#pragma once

#include "import.hpp"

namespace restage::pbrt {

struct Mesh {
    std::vector<float> positions, normals, uvs; // 3, 3 and 2 per vertex; the last two may be empty
    std::vector<std::uint32_t> indices; // 3 per triangle
    std::size_t vertex_count() const { return positions.size() / 3; }
    std::size_t triangle_count() const { return indices.size() / 3; }
    bool has_bent_quads = false; // polygons that were not flat before they were split
};

// Area after `to_world`; triangle by triangle, in double.
double area(const Mesh& mesh, const Matrix& to_world);

// pbrt's quadrics: sphere, disk, cylinder; of v3 also cone, paraboloid, hyperboloid. nullopt: another shape.
// The tessellation is scaled about the axis (or centre) so that its area is the exact one: area lights keep their
// power.
std::optional<Mesh> make_quadric(Import& import, const Directive& shape);
Mesh make_triangle_mesh(Import& import, const Directive& shape); // trianglemesh
Mesh make_bilinear(Import& import, const Directive& shape); // bilinearmesh
Mesh make_loop(Import& import, const Directive& shape); // loopsubdiv, limit positions and normals
Mesh make_heightfield(Import& import, const Directive& shape); // v3
Mesh make_nurbs(Import& import, const Directive& shape); // v3

// A PLY file: ascii, binary of either byte order, gzip, polygons of any size. Throws ImportError{at} if it is broken.
Mesh read_ply(const std::string& path, std::string_view bytes, Location at);

// v3: a parameter of a shape that its material reads first.
bool is_material_parameter(std::string_view name);

// Normals that are zero or not finite are replaced by the mean of the faces around. Returns how many.
std::size_t repair_normals(Mesh& mesh);

} // namespace restage::pbrt

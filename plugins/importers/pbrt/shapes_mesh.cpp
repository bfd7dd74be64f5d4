// SPDX-License-Identifier: Apache-2.0
// Shapes whose vertices are in the scene file: trianglemesh, bilinearmesh, heightfield.
#include "mesh.hpp"

#include <algorithm>
#include <cmath>

namespace restage::pbrt {

namespace {

// `width` numbers per vertex; throws if the count is not a multiple or a value does not fit a float.
std::vector<float> vertex_array(Import& import, const Directive& shape, const char* name, std::size_t width) {
    const Param* param = shape.params.has(name) ? shape.params.find(name) : nullptr;
    std::vector<float> out;
    if (!param) return out;
    const std::size_t excess = param->numbers.size() % width;
    if (import.v3() && excess > 0) { // parser.cpp, AddParam
        import.warned(param->at, "\"" + param->name + "\" of Shape \"" + shape.name + "\"",
                      std::to_string(excess) + " surplus numbers; the last ones are left out");
        Directive whole;
        whole.name = shape.name;
        whole.params.params = {*param};
        auto& numbers = whole.params.params[0].numbers;
        numbers.resize(numbers.size() - excess);
        return vertex_array(import, whole, name, width);
    }
    if (!param->strings.empty() || !param->bools.empty() || param->numbers.size() % width != 0)
        throw ImportError{param->at,
                          "\"" + param->name + "\" of Shape \"" + shape.name + "\" needs " + std::to_string(width) +
                              " numbers per vertex; " + std::to_string(param->numbers.size()) + " are given",
                          true};
    out.reserve(param->numbers.size());
    for (const double value : param->numbers) {
        if (!(std::abs(value) < 1e38))
            throw ImportError{param->at, "\"" + param->name + "\" holds " + shortest(value) + ", which is too large"};
        out.push_back(static_cast<float>(value));
    }
    return out;
}

// A per-vertex array that pbrt discards if its length is wrong.
std::vector<float> matching(Import& import, const Directive& shape, const char* name, std::size_t width,
                            std::size_t vertices) {
    std::vector<float> out = vertex_array(import, shape, name, width);
    if (import.v3() && width == 2 && out.size() > width * vertices) { // triangle.cpp: more uv than will be used
        import.warned(shape.at, "\"" + std::string(name) + "\" of Shape \"" + shape.name + "\"",
                      "more of them than vertices; the last ones are left out");
        out.resize(width * vertices);
    }
    if (!out.empty() && out.size() != width * vertices) {
        import.lost(
            shape.at, "\"" + std::string(name) + "\" of Shape \"" + shape.name + "\"",
            "it has " + std::to_string(out.size() / width) + " entries for " + std::to_string(vertices) + " vertices");
        out.clear();
    }
    return out;
}

void drop_face_indices(Import& import, const Directive& shape) {
    if (shape.params.find("faceIndices"))
        import.dropped(shape.at, "\"faceIndices\" of Shape \"" + shape.name + "\"",
                       "numbers of faces (for Ptex) are not kept");
    if (shape.params.find("S"))
        import.dropped(shape.at, "\"S\" of Shape \"" + shape.name + "\"", "tangents are made from uv");
}

} // namespace

Mesh make_triangle_mesh(Import& import, const Directive& shape) {
    Mesh mesh;
    mesh.positions = vertex_array(import, shape, "P", 3);
    const std::size_t vertices = mesh.vertex_count();
    if (vertices == 0) throw ImportError{shape.at, "Shape \"trianglemesh\" has no vertices; give \"point3 P\""};
    mesh.indices = shape.params.indices("indices", vertices);
    if (mesh.indices.empty() && vertices == 3) mesh.indices = {0, 1, 2}; // v4
    if (mesh.indices.empty())
        throw ImportError{shape.at, "Shape \"trianglemesh\" has no faces; give \"integer indices\""};
    if (mesh.indices.size() % 3 != 0) {
        import.warned(shape.at, "Shape \"trianglemesh\"",
                      "its indices are not a multiple of 3; the last ones are left out");
        mesh.indices.resize(mesh.indices.size() / 3 * 3);
    }
    mesh.uvs = matching(import, shape, shape.params.has("uv") ? "uv" : "st", 2, vertices);
    mesh.normals = matching(import, shape, "N", 3, vertices);
    drop_face_indices(import, shape);
    return mesh;
}

// A bilinear patch p00, p10, p01, p11 (pbrt-v4 book, sec. 6.6): flat ones are two triangles, bent ones a grid. The
// normal is dp/du x dp/dv of pbrt, or the interpolated N.
Mesh make_bilinear(Import& import, const Directive& shape) {
    const std::vector<float> p = vertex_array(import, shape, "P", 3);
    const std::size_t vertices = p.size() / 3;
    if (vertices == 0) throw ImportError{shape.at, "Shape \"bilinearmesh\" has no vertices; give \"point3 P\""};
    auto corners = shape.params.indices("indices", vertices);
    if (corners.empty() && vertices == 4) corners = {0, 1, 2, 3};
    if (corners.size() > 4 && corners.size() % 4 != 0) {
        import.warned(shape.at, "Shape \"bilinearmesh\"",
                      "its indices are not a multiple of 4; the last ones are left out");
        corners.resize(corners.size() / 4 * 4);
    }
    if (corners.empty() || corners.size() % 4 != 0)
        throw ImportError{shape.at, "Shape \"bilinearmesh\" needs four \"integer indices\" a patch"};
    const std::vector<float> uv = matching(import, shape, "uv", 2, vertices),
                             n = matching(import, shape, "N", 3, vertices);
    drop_face_indices(import, shape);
    if (shape.params.find("emissionfilename"))
        import.dropped(shape.at, "\"emissionfilename\"", "pictures as emission are not rendered");
    const auto corner = [](const std::vector<float>& from, std::size_t i) {
        return Vec3{double(from[3 * i]), double(from[3 * i + 1]), double(from[3 * i + 2])};
    };
    Mesh mesh;
    for (std::size_t c = 0; c < corners.size(); c += 4) {
        const std::size_t v[4] = {corners[c], corners[c + 1], corners[c + 2], corners[c + 3]};
        const Vec3 p00 = corner(p, v[0]), p10 = corner(p, v[1]), p01 = corner(p, v[2]), p11 = corner(p, v[3]);
        const Vec3 twist = p00 - p10 - p01 + p11;
        const double size = length(p10 - p00) + length(p01 - p00);
        const int steps = length(twist) <= 1e-6 * size ? 1 : 16; // a parallelogram is two triangles exactly
        if (mesh.vertex_count() + std::size_t(steps + 1) * std::size_t(steps + 1) > (1u << 26))
            throw ImportError{shape.at, "Shape \"bilinearmesh\" has too many bent patches for one mesh; split it"};
        const auto base = static_cast<std::uint32_t>(mesh.vertex_count());
        for (int j = 0; j <= steps; ++j)
            for (int i = 0; i <= steps; ++i) {
                const double s = double(i) / steps, t = double(j) / steps;
                const double w[4] = {(1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t};
                const Vec3 at = p00 * w[0] + p10 * w[1] + p01 * w[2] + p11 * w[3];
                Vec3 normal = cross((p10 - p00) * (1 - t) + (p11 - p01) * t, (p01 - p00) * (1 - s) + (p11 - p10) * s);
                if (!n.empty())
                    normal = corner(n, v[0]) * w[0] + corner(n, v[1]) * w[1] + corner(n, v[2]) * w[2] +
                             corner(n, v[3]) * w[3];
                normal = normalize(normal);
                for (const double x : {at.x, at.y, at.z})
                    mesh.positions.push_back(static_cast<float>(x));
                for (const double x : {normal.x, normal.y, normal.z})
                    mesh.normals.push_back(static_cast<float>(x));
                double st[2] = {s, t};
                if (!uv.empty())
                    for (std::size_t k = 0; k < 2; ++k) {
                        st[k] = 0;
                        for (std::size_t q = 0; q < 4; ++q)
                            st[k] += w[q] * double(uv[2 * v[q] + k]);
                    }
                for (const double x : st)
                    mesh.uvs.push_back(static_cast<float>(x));
            }
        const auto row = static_cast<std::uint32_t>(steps + 1);
        for (std::uint32_t j = 0; j < row - 1; ++j)
            for (std::uint32_t i = 0; i < row - 1; ++i) {
                const std::uint32_t a = base + j * row + i, b = a + 1, d = a + row, e = d + 1;
                mesh.indices.insert(mesh.indices.end(), {a, b, e, a, e, d});
            }
    }
    return mesh;
}

Mesh make_heightfield(Import&, const Directive& shape) { // pbrt-v3: z over the unit square
    const int nu = shape.params.integer("nu", -1), nv = shape.params.integer("nv", -1);
    const std::vector<double>* z = shape.params.numbers("Pz");
    if (nu < 2 || nv < 2 || !z || z->size() != std::size_t(nu) * std::size_t(nv))
        throw ImportError{shape.at, "Shape \"heightfield\" needs nu, nv >= 2 and nu * nv numbers \"Pz\""};
    Mesh mesh;
    for (int y = 0; y < nv; ++y)
        for (int x = 0; x < nu; ++x) {
            const double u = double(x) / (nu - 1), v = double(y) / (nv - 1);
            for (const double value : {u, v, (*z)[std::size_t(y) * std::size_t(nu) + std::size_t(x)]})
                mesh.positions.push_back(static_cast<float>(value));
            for (const double value : {u, v})
                mesh.uvs.push_back(static_cast<float>(value));
        }
    const auto columns = static_cast<std::uint32_t>(nu);
    for (std::uint32_t y = 0; y + 1 < static_cast<std::uint32_t>(nv); ++y)
        for (std::uint32_t x = 0; x + 1 < columns; ++x) {
            const std::uint32_t a = y * columns + x, b = a + 1, c = b + columns, d = a + columns;
            mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
        }
    return mesh;
}

} // namespace restage::pbrt

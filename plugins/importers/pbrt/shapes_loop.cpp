// SPDX-License-Identifier: Apache-2.0
// Loop subdivision (Loop 1987) with the masks of pbrt (pbrt-v3 book, sec. 3.8; boundary and limit masks of Hoppe et al.
// 1994 and Zorin et al., SIGGRAPH 2000 course), vertices pushed to the limit surface, limit normals. Meshes that are
// not manifold are accepted: an edge of three faces is treated as a boundary.
#include "mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <unordered_map>

namespace restage::pbrt {

namespace {

using Faces = std::vector<std::array<std::uint32_t, 3>>;

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
    return (std::uint64_t(std::min(a, b)) << 32) | std::max(a, b);
}

struct Edge {
    std::uint32_t count = 0; // faces that share it
    std::uint32_t opposite[2]{}; // their third vertices
    std::uint32_t middle = 0; // the new vertex
};
using Edges = std::unordered_map<std::uint64_t, Edge>;

struct Neighbourhood { // of one vertex
    Vec3 sum;
    int valence = 0;
    int boundary_edges = 0;
    Vec3 boundary_sum;
};

Edges find_edges(const Faces& faces) {
    Edges edges;
    edges.reserve(faces.size() * 3 / 2 + 16);
    for (const auto& face : faces)
        for (std::size_t k = 0; k < 3; ++k) {
            Edge& edge = edges[edge_key(face[k], face[(k + 1) % 3])];
            if (edge.count < 2) edge.opposite[edge.count] = face[(k + 2) % 3];
            ++edge.count;
        }
    return edges;
}

std::vector<Neighbourhood> find_neighbours(const std::vector<Vec3>& points, const Edges& edges) {
    std::vector<Neighbourhood> out(points.size());
    for (const auto& [key, edge] : edges) {
        const std::uint32_t ends[2] = {static_cast<std::uint32_t>(key >> 32), static_cast<std::uint32_t>(key)};
        for (int k = 0; k < 2; ++k) {
            Neighbourhood& at = out[ends[k]];
            const Vec3 other = points[ends[1 - k]];
            at.sum = at.sum + other;
            ++at.valence;
            if (edge.count == 2) continue;
            ++at.boundary_edges;
            at.boundary_sum = at.boundary_sum + other;
        }
    }
    return out;
}

double beta(int valence) { return valence == 3 ? 3.0 / 16 : 3.0 / (8.0 * valence); }

// Weight `interior` of each neighbour, or `boundary` of the two along a boundary; corners stay.
Vec3 masked(Vec3 p, const Neighbourhood& at, double interior, double boundary) {
    if (at.valence == 0) return p;
    if (at.boundary_edges == 0) return p * (1 - at.valence * interior) + at.sum * interior;
    if (at.boundary_edges == 2) return p * (1 - 2 * boundary) + at.boundary_sum * boundary;
    return p;
}

void subdivide(std::vector<Vec3>& points, Faces& faces) {
    Edges edges = find_edges(faces);
    const auto around = find_neighbours(points, edges);
    std::vector<Vec3> next(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        next[i] = masked(points[i], around[i], around[i].valence ? beta(around[i].valence) : 0, 1.0 / 8);
    Faces out;
    out.reserve(faces.size() * 4);
    for (const auto& face : faces) {
        std::uint32_t middle[3];
        for (std::size_t k = 0; k < 3;
             ++k) { // in the order of the faces, so that the result does not depend on the hash
            Edge& edge = edges[edge_key(face[k], face[(k + 1) % 3])];
            if (edge.middle == 0) {
                const Vec3 ends = points[face[k]] + points[face[(k + 1) % 3]];
                next.push_back(edge.count == 2 ? ends * (3.0 / 8) +
                                                     (points[edge.opposite[0]] + points[edge.opposite[1]]) * (1.0 / 8)
                                               : ends * 0.5);
                edge.middle = static_cast<std::uint32_t>(next.size()); // + 1: 0 is "none yet"
            }
            middle[k] = edge.middle - 1;
        }
        out.push_back({face[0], middle[0], middle[2]});
        out.push_back({middle[0], face[1], middle[1]});
        out.push_back({middle[2], middle[1], face[2]});
        out.push_back({middle[0], middle[1], middle[2]});
    }
    points = std::move(next);
    faces = std::move(out);
}

// The ring around a vertex, counter-clockwise, from the follower a -> b of each face (v, a, b). Empty: no ring.
std::vector<std::uint32_t> ring_of(const std::vector<std::pair<std::uint32_t, std::uint32_t>>& links, bool boundary) {
    std::uint32_t start = links.front().first;
    if (boundary) {
        for (const auto& [a, b] : links) {
            const bool has_before =
                std::any_of(links.begin(), links.end(), [from = a](const auto& other) { return other.second == from; });
            if (!has_before) start = a;
        }
    }
    std::vector<std::uint32_t> ring{start};
    while (ring.size() <= links.size()) {
        const auto next =
            std::find_if(links.begin(), links.end(), [&](const auto& link) { return link.first == ring.back(); });
        if (next == links.end() || next->second == start) break;
        ring.push_back(next->second);
    }
    return ring.size() == links.size() + (boundary ? 1 : 0) ? ring : std::vector<std::uint32_t>{};
}

// Limit tangents, S x T along the winding; pbrt-v3 book, sec. 3.8.3.
Vec3 limit_normal(const std::vector<Vec3>& points, Vec3 p, const std::vector<std::uint32_t>& ring, bool boundary) {
    const auto n = static_cast<int>(ring.size());
    const auto at = [&](int k) { return points[ring[static_cast<std::size_t>(k)]]; };
    Vec3 s, t;
    if (!boundary) {
        for (int k = 0; k < n; ++k) {
            const double angle = 2 * std::numbers::pi * k / n;
            s = s + at(k) * std::cos(angle);
            t = t + at(k) * std::sin(angle);
        }
        return cross(s, t);
    }
    s = at(n - 1) - at(0);
    if (n == 2) {
        t = at(0) + at(1) - p * 2;
    } else if (n == 3) {
        t = at(1) - p;
    } else if (n == 4) {
        t = at(1) * 2 + at(2) * 2 - at(0) - at(3) - p * 2;
    } else {
        const double theta = std::numbers::pi / (n - 1);
        t = (at(0) + at(n - 1)) * std::sin(theta);
        for (int k = 1; k < n - 1; ++k)
            t = t + at(k) * ((2 * std::cos(theta) - 2) * std::sin(k * theta));
        t = t * -1;
    }
    return cross(t, s); // S runs clockwise along the boundary
}

} // namespace

Mesh make_loop(Import& import, const Directive& shape) {
    const int levels = shape.params.integer(shape.params.has("levels") ? "levels" : "nlevels", 3);
    const std::vector<double>* p = shape.params.numbers("P");
    if (!p || p->empty() || p->size() % 3 != 0)
        throw ImportError{shape.at, "Shape \"loopsubdiv\" needs \"point3 P\", three numbers per vertex"};
    const auto indices = shape.params.indices("indices", p->size() / 3);
    if (indices.empty() || indices.size() % 3 != 0)
        throw ImportError{shape.at, "Shape \"loopsubdiv\" needs \"integer indices\", three a face"};
    const std::string scheme = shape.params.string("scheme", "loop");
    if (scheme != "loop")
        import.approximated(shape.at, "Shape \"loopsubdiv\"", "scheme " + quote(scheme) + " is treated as loop");
    constexpr double most = 1u << 23; // about 2 GB while it is built
    if (levels < 0 || double(indices.size()) / 3 * std::pow(4.0, levels) > most)
        throw ImportError{shape.at, "Shape \"loopsubdiv\" with " + std::to_string(levels) +
                                        " levels has more than 2^23 triangles; use fewer levels"};
    std::vector<Vec3> points(p->size() / 3);
    for (std::size_t i = 0; i < points.size(); ++i)
        points[i] = {(*p)[3 * i], (*p)[3 * i + 1], (*p)[3 * i + 2]};
    Faces faces(indices.size() / 3);
    for (std::size_t i = 0; i < indices.size(); ++i)
        faces[i / 3][i % 3] = indices[i];
    std::erase_if(faces, [](const auto& f) { return f[0] == f[1] || f[1] == f[2] || f[2] == f[0]; });
    for (int level = 0; level < levels; ++level)
        subdivide(points, faces);

    const Edges edges = find_edges(faces);
    const auto around = find_neighbours(points, edges);
    std::vector<Vec3> limit(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        const int n = around[i].valence;
        limit[i] = masked(points[i], around[i], n ? 1 / (n + 3 / (8 * beta(n))) : 0, 1.0 / 5);
    }
    std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>> links(points.size());
    for (const auto& face : faces)
        for (std::size_t k = 0; k < 3; ++k)
            links[face[k]].emplace_back(face[(k + 1) % 3], face[(k + 2) % 3]);
    Mesh mesh;
    for (std::size_t i = 0; i < points.size(); ++i) {
        Vec3 normal;
        if (!links[i].empty()) {
            const bool boundary = around[i].boundary_edges > 0;
            const auto ring = ring_of(links[i], boundary);
            // pbrt takes the tangents from points already on the limit surface.
            if (!ring.empty()) normal = limit_normal(limit, limit[i], ring, boundary);
        }
        // pbrt walks rings against the winding, so its normals are against cross(e1, e2): the faces are turned to
        // match.
        normal = normalize(normal) * -1;
        for (const double x : {limit[i].x, limit[i].y, limit[i].z})
            mesh.positions.push_back(static_cast<float>(x));
        for (const double x : {normal.x, normal.y, normal.z})
            mesh.normals.push_back(static_cast<float>(x));
    }
    for (const auto& face : faces)
        mesh.indices.insert(mesh.indices.end(), {face[0], face[2], face[1]});
    return mesh;
}

} // namespace restage::pbrt

// SPDX-License-Identifier: Apache-2.0
#include "common/tangents.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

namespace restage::importing {

namespace {

Vec3 vec3_at(const std::vector<float>& v, std::size_t i) { return {v[3 * i], v[3 * i + 1], v[3 * i + 2]}; }
Vec3 across(Vec3 v, Vec3 n) { return v - n * dot(v, n); }

// Classes of vertices that share one tangent frame point.
std::vector<std::uint32_t> weld(const MeshBuffer& mesh, const std::vector<float>& uv) {
    using Key = std::array<std::uint32_t, 8>; // by bits: a total order even with NaN
    const auto bits = [](float x) { return std::bit_cast<std::uint32_t>(x + 0.f); }; // -0 is 0
    std::vector<Key> keys(mesh.vertex_count());
    for (std::size_t i = 0; i < keys.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            keys[i][c] = bits(mesh.positions[3 * i + c]);
            keys[i][3 + c] = mesh.normals.empty() ? 0u : bits(mesh.normals[3 * i + c]);
        }
        keys[i][6] = bits(uv[2 * i]);
        keys[i][7] = bits(uv[2 * i + 1]);
    }
    const auto less = [&](std::uint32_t a, std::uint32_t b) { return std::tie(keys[a], a) < std::tie(keys[b], b); };
    std::vector<std::uint32_t> order(keys.size()), result(keys.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(), less);
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && keys[order[i - 1]] == keys[order[i]];
        result[order[i]] = same ? result[order[i - 1]] : order[i];
    }
    return result;
}

struct Triangle {
    Vec3 tangent{}; // unit, along u; zero if uv are degenerate
    int side = 0;   // 1, or -1 if uv are mirrored; 0: unknown
};

class Groups { // of corners; union-find
  public:
    explicit Groups(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void unite(std::uint32_t a, std::uint32_t b) {
        a = find(a), b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::uint32_t> parent_;
};

void append_vertex(MeshBuffer& mesh, std::size_t from) {
    const auto copy = [from](std::vector<float>& values, std::size_t n) {
        for (std::size_t c = 0; c < n && !values.empty(); ++c)
            values.push_back(values[n * from + c]);
    };
    copy(mesh.positions, 3);
    copy(mesh.normals, 3);
    copy(mesh.uvs, 2);
    copy(mesh.uvs2, 2);
}

std::vector<Triangle> triangles_of(const MeshBuffer& mesh, const std::vector<float>& uv) {
    std::vector<Triangle> triangles(mesh.triangle_count());
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const std::uint32_t* c = &mesh.indices[3 * t];
        const auto u = [&](int k, std::size_t axis) {
            return static_cast<double>(uv[2 * c[k] + axis]) - static_cast<double>(uv[2 * c[0] + axis]);
        };
        const double area = u(1, 0) * u(2, 1) - u(2, 0) * u(1, 1);
        if (area == 0 || !std::isfinite(area)) continue;
        const Vec3 p = mesh.position(c[0]);
        triangles[t].side = area > 0 ? 1 : -1;
        triangles[t].tangent = normalized(
            ((mesh.position(c[1]) - p) * u(2, 1) - (mesh.position(c[2]) - p) * u(1, 1)) * triangles[t].side, {0, 0, 0});
    }
    return triangles;
}

struct Edge { // of welded vertices, and the triangle's corner
    std::uint32_t low, high, triangle;
    bool turned; // runs from high to low there
    auto key() const { return std::tuple(low, high, triangle); }
};

std::vector<Edge> edges_of(const MeshBuffer& mesh, const std::vector<std::uint32_t>& point) {
    std::vector<Edge> edges;
    edges.reserve(mesh.indices.size());
    for (std::uint32_t i = 0; i < mesh.indices.size(); ++i) {
        const std::uint32_t a = point[mesh.indices[i]], b = point[mesh.indices[i % 3 == 2 ? i - 2 : i + 1]];
        if (a != b) edges.push_back({std::min(a, b), std::max(a, b), i / 3, a > b});
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.key() < b.key(); });
    return edges;
}

} // namespace

void make_tangents(MeshBuffer& mesh, std::vector<float> uv) {
    if (mesh.normals.empty()) { // flat: no two triangles share a normal, so no corner is shared
        MeshBuffer apart;
        std::vector<float> uv_apart;
        const auto gather = [&](const std::vector<float>& from, std::vector<float>& to, std::size_t n) {
            for (const std::uint32_t i : mesh.indices)
                for (std::size_t c = 0; c < n && !from.empty(); ++c)
                    to.push_back(from[n * i + c]);
        };
        gather(mesh.positions, apart.positions, 3);
        gather(mesh.uvs, apart.uvs, 2);
        gather(mesh.uvs2, apart.uvs2, 2);
        gather(uv, uv_apart, 2);
        apart.indices.resize(mesh.indices.size());
        std::iota(apart.indices.begin(), apart.indices.end(), 0u);
        mesh = std::move(apart);
        uv = std::move(uv_apart);
    }
    std::vector<Triangle> triangles = triangles_of(mesh, uv);
    Groups groups(mesh.indices.size());
    if (!mesh.normals.empty()) {
        const std::vector<std::uint32_t> point = weld(mesh, uv);
        const std::vector<Edge> edges = edges_of(mesh, point);
        const auto corner_at = [&](const Edge& e, std::uint32_t p) {
            std::uint32_t corner = 3 * e.triangle;
            while (point[mesh.indices[corner]] != p)
                ++corner;
            return corner;
        };
        for (std::size_t i = 1; i < edges.size(); ++i) {
            const Edge &a = edges[i - 1], &b = edges[i];
            if (a.low != b.low || a.high != b.high || a.turned == b.turned) continue;
            int &x = triangles[a.triangle].side, &y = triangles[b.triangle].side;
            if (x == 0) x = y; // degenerate uv: it joins its neighbour
            if (y == 0) y = x;
            if (x != y) continue;
            groups.unite(corner_at(a, a.low), corner_at(b, a.low));
            groups.unite(corner_at(a, a.high), corner_at(b, a.high));
        }
    }
    const auto face_normal = [&](std::size_t t) {
        const std::uint32_t* c = &mesh.indices[3 * t];
        const Vec3 p = mesh.position(c[0]);
        return normalized(cross(mesh.position(c[1]) - p, mesh.position(c[2]) - p));
    };
    const auto normal_at = [&](std::size_t corner) {
        return mesh.normals.empty() ? face_normal(corner / 3)
                                    : normalized(vec3_at(mesh.normals, mesh.indices[corner]), face_normal(corner / 3));
    };
    std::vector<Vec3> sums(mesh.indices.size(), Vec3{});
    for (std::uint32_t i = 0; i < mesh.indices.size(); ++i) {
        const std::uint32_t first = i - i % 3;
        const Vec3 n = normal_at(i), p = mesh.position(mesh.indices[i]);
        const auto towards = [&](std::uint32_t k) {
            return normalized(across(mesh.position(mesh.indices[first + (i + k) % 3]) - p, n), {0, 0, 0});
        };
        const double angle = std::acos(std::clamp(dot(towards(1), towards(2)), -1.0, 1.0));
        Vec3& sum = sums[groups.find(i)];
        sum = sum + normalized(across(triangles[i / 3].tangent, n), {0, 0, 0}) * angle;
    }
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> split; // vertex and group -> vertex
    std::vector<char> taken(mesh.vertex_count());
    mesh.tangents.assign(std::size_t{4} * mesh.vertex_count(), 0.f);
    for (std::uint32_t i = 0; i < mesh.indices.size(); ++i) {
        std::uint32_t& vertex = mesh.indices[i];
        const std::uint32_t group = groups.find(i);
        const Vec3 n = normal_at(i);
        const auto [place, fresh] = split.try_emplace({vertex, group}, vertex);
        if (fresh && taken[vertex]) {
            append_vertex(mesh, vertex);
            mesh.tangents.resize(mesh.tangents.size() + 4);
            place->second = mesh.vertex_count() - 1;
        } else if (fresh) {
            taken[vertex] = 1;
        }
        vertex = place->second;
        if (!fresh) continue;
        const Vec3 any = std::abs(n[0]) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
        const Vec3 t = normalized(sums[group], normalized(across(any, n)));
        for (std::size_t c = 0; c < 3; ++c)
            mesh.tangents[4 * vertex + c] = static_cast<float>(t[c]);
        mesh.tangents[4 * vertex + 3] = triangles[i / 3].side < 0 ? -1.f : 1.f;
    }
}

} // namespace restage::importing

// SPDX-License-Identifier: Apache-2.0
// TriangleTree: a hierarchy of boxes over a mesh's triangles in world space, and the pairs of two of them that come
// near each other while one moves in a straight line.
#pragma once

#include "query/triangle_sweep.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace restage::query {

// The first t in [0, most] at which t * by is in that box; infinite: none.
inline double box_entry(const glm::dvec3& lower, const glm::dvec3& upper, const glm::dvec3& by, double most) {
    double enter = 0, exit = most;
    for (int i = 0; i < 3; ++i) {
        if (by[i] == 0) {
            if (lower[i] > 0 || upper[i] < 0) return std::numeric_limits<double>::infinity();
            continue;
        }
        enter = std::max(enter, (by[i] > 0 ? lower : upper)[i] / by[i]);
        exit = std::min(exit, (by[i] > 0 ? upper : lower)[i] / by[i]);
    }
    return enter <= exit ? enter : std::numeric_limits<double>::infinity();
}

class TriangleTree {
  public:
    // Triangles without area are left out: others share their edges.
    TriangleTree(std::shared_ptr<const scene::MeshData>, const glm::dmat4& object_to_world);

    struct Node {
        glm::vec3 lower{0};
        std::uint32_t first = 0; // of two children that follow each other, or of its triangles
        glm::vec3 upper{0};
        std::uint32_t count = 0; // of triangles; 0 = it has children
        float size() const { return (upper.x - lower.x) + (upper.y - lower.y) + (upper.z - lower.z); }
    };
    const std::vector<Node>& nodes() const { return nodes_; } // from the root; none without triangles
    Triangle triangle(std::size_t i) const; // in the leaves' order

    // visit(t, u) for triangles t of `a`, displaced by `offset`, and u of `b`, if boxes around them come as close as
    // `margin` while t is displaced by up to most * by more. visit may lower `most`; < 0 ends it.
    template <class F>
    static void each_pair(const TriangleTree& a, const glm::dvec3& offset, const glm::dvec3& by, const TriangleTree& b,
                          double margin, const double& most, F&& visit);

  private:
    std::shared_ptr<const scene::MeshData> mesh_;
    glm::dmat4 place_;
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
};

template <class F>
void TriangleTree::each_pair(const TriangleTree& a, const glm::dvec3& offset, const glm::dvec3& by,
                             const TriangleTree& b, double margin, const double& most, F&& visit) {
    if (a.nodes_.empty() || b.nodes_.empty()) return;
    struct Pair {
        std::uint32_t a, b;
        double enter;
    };
    std::vector<Pair> stack;
    const auto look = [&](std::uint32_t i, std::uint32_t j) {
        const Node &x = a.nodes_[i], &y = b.nodes_[j];
        const double enter = box_entry(glm::dvec3(y.lower) - glm::dvec3(x.upper) - offset - margin,
                                       glm::dvec3(y.upper) - glm::dvec3(x.lower) - offset + margin, by, most);
        if (enter <= most) stack.push_back({i, j, enter});
    };
    look(0, 0);
    while (!stack.empty()) {
        const Pair pair = stack.back();
        stack.pop_back();
        if (pair.enter > most) continue;
        const Node &x = a.nodes_[pair.a], &y = b.nodes_[pair.b];
        if (x.count > 0 && y.count > 0) {
            for (std::uint32_t i = x.first; i < x.first + x.count; ++i) {
                Triangle t = a.triangle(i);
                for (glm::dvec3& corner : t)
                    corner += offset;
                for (std::uint32_t j = y.first; j < y.first + y.count; ++j)
                    visit(t, b.triangle(j));
            }
            continue;
        }
        const std::size_t before = stack.size();
        if (x.count == 0 && (y.count > 0 || x.size() > y.size())) {
            look(x.first, pair.b);
            look(x.first + 1, pair.b);
        } else {
            look(pair.a, y.first);
            look(pair.a, y.first + 1);
        }
        // The nearer one next.
        if (stack.size() == before + 2 && stack[before].enter < stack[before + 1].enter)
            std::swap(stack[before], stack[before + 1]);
    }
}

} // namespace restage::query

// SPDX-License-Identifier: Apache-2.0
// The parts that things are made of, and which of them belong together (things.hpp). Internal to query. All coordinates
// have z up.
#pragma once

#include "scene/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace restage::query {

class Union {
  public:
    explicit Union(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }
    std::uint32_t root(std::uint32_t i) {
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) { parent_[std::max(root(a), root(b))] = std::min(root(a), root(b)); }

  private:
    std::vector<std::uint32_t> parent_;
};

inline double diagonal(const scene::Bounds& b) { return b.empty() ? 0 : glm::length(b.size()); }
inline scene::Bounds grown(scene::Bounds b, double by) {
    b.lower -= by;
    b.upper += by;
    return b;
}
inline bool overlap(const scene::Bounds& a, const scene::Bounds& b) {
    return glm::all(glm::lessThanEqual(a.lower, b.upper)) && glm::all(glm::lessThanEqual(b.lower, a.upper));
}
inline bool holds(const scene::Bounds& b, const glm::dvec3& p) {
    return glm::all(glm::lessThanEqual(b.lower, p)) && glm::all(glm::lessThanEqual(p, b.upper));
}

// Around points, its sides turned by `angle` from the axes. The centre is in the turned axes.
struct Rectangle {
    double angle = 0;
    glm::dvec2 center{0}, size{0};

    Rectangle(std::span<const glm::dvec2> points, double turned) : angle(turned) {
        const glm::dvec2 x(std::cos(angle), std::sin(angle)), y(-x.y, x.x);
        glm::dvec2 lower(1e300), upper(-1e300);
        for (const glm::dvec2& p : points) {
            const glm::dvec2 q(glm::dot(p, x), glm::dot(p, y));
            lower = glm::min(lower, q), upper = glm::max(upper, q);
        }
        if (!points.empty()) center = 0.5 * (lower + upper), size = upper - lower;
    }
    static Rectangle smallest(std::span<const glm::dvec2> points) {
        constexpr int angles = 24; // of a quarter turn
        Rectangle best(points, 0);
        for (int i = 1; i < angles; ++i)
            if (const Rectangle one(points, 0.5 * std::numbers::pi * i / angles); one.area() < best.area()) best = one;
        return best;
    }
    double area() const { return size.x * size.y; }
};

// visit(i, j), i < j, for pairs of boxes that overlap. Sweeps along x.
template <class F>
void each_overlap(std::span<const scene::Bounds> boxes, F&& visit) {
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
        if (!boxes[i].empty()) order.push_back(i);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return boxes[a].lower.x < boxes[b].lower.x; });
    std::vector<std::uint32_t> open;
    for (const std::uint32_t i : order) {
        std::erase_if(open, [&](std::uint32_t j) { return boxes[j].upper.x < boxes[i].lower.x; });
        for (const std::uint32_t j : open)
            if (overlap(boxes[i], boxes[j])) visit(std::min(i, j), std::max(i, j));
        open.push_back(i);
    }
}

struct Unit { // stays together: a group, or a single object
    std::vector<std::uint32_t> parts;
    scene::Bounds box;
    bool architecture = false;
    bool own = false; // grouped by the user
    double mounted = 0; // share of its surface on walls
    bool anchored = false; // it has its own place: on a floor, on a wall, on something
    scene::Id<scene::Mesh> mesh; // of a single object
    std::size_t points = 0; // of its surface, sampled
    std::vector<glm::dvec2> outline; // some of these, seen from above
    Rectangle footprint{{}, 0}; // around these
};
using Pair = std::pair<std::uint32_t, std::uint32_t>; // of units
struct Contact { // of units a and b, a < b
    std::vector<glm::dvec3> on_a, on_b; // points of their surfaces near the other's
    double gap = 0;
};

// Which units belong together. Marks those that have a place of their own as anchored.
Union join_units(std::span<Unit> units, const std::map<Pair, Contact>& touching);

// Likewise for all units that were joined with one that is.
void spread_anchors(std::span<Unit> units, Union& joined);

} // namespace restage::query

// SPDX-License-Identifier: Apache-2.0
#include "render/light_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <span>

namespace restage::render {
namespace {

using shared::LightNode;
using Nodes = std::span<LightNode>;

// The sphere around both.
void merge_spheres(LightNode& a, const LightNode& b) {
    const glm::dvec3 d = glm::dvec3(b.center) - glm::dvec3(a.center);
    const double distance = glm::length(d);
    if (distance + b.radius <= a.radius) return;
    if (distance + a.radius <= b.radius) {
        a.center = b.center;
        a.radius = b.radius;
        return;
    }
    const double radius = 0.5 * (distance + a.radius + b.radius);
    a.center = glm::dvec3(a.center) + d * ((radius - a.radius) / distance);
    a.radius = float(radius * (1 + 1e-6));
}

// The cone of normals around both; cos_spread -1: all directions.
void merge_cones(LightNode& a, const LightNode& b) {
    const auto angle = [](float c) { return std::acos(std::clamp(double(c), -1.0, 1.0)); };
    const double a_o = angle(a.cos_spread), b_o = angle(b.cos_spread);
    const double between = angle(glm::dot(a.axis, b.axis));
    a.cos_reach = std::min(a.cos_reach, b.cos_reach);
    if (between + b_o <= a_o) return;
    if (between + a_o <= b_o) {
        a.axis = b.axis;
        a.cos_spread = b.cos_spread;
        return;
    }
    const double spread = 0.5 * (between + a_o + b_o) + 1e-4;
    const glm::dvec3 across = glm::dvec3(b.axis) - glm::dvec3(a.axis) * double(glm::dot(a.axis, b.axis));
    if (spread >= std::numbers::pi || glm::length(across) < 1e-6) {
        a.cos_spread = -1;
        return;
    }
    const double turn = spread - a_o;
    a.axis = std::cos(turn) * glm::dvec3(a.axis) + std::sin(turn) * glm::normalize(across);
    a.cos_spread = float(std::cos(spread));
}

LightNode merged(Nodes nodes) {
    LightNode sum = nodes[0];
    sum.lights = 0;
    double intensity = sum.intensity;
    for (const LightNode& n : nodes.subspan(1)) {
        intensity += n.intensity;
        sum.flags |= n.flags;
        if (sum.radius < 0) continue; // infinitely far, as all of them
        merge_spheres(sum, n);
        merge_cones(sum, n);
    }
    sum.intensity = float(intensity);
    return sum;
}

bool far(const LightNode& n) { return n.radius < 0; }

// Splits in two, where the sum of intensity times area of bounds is least among 16 places along the longest axis;
// without an extent, in the middle.
std::size_t split(Nodes nodes) {
    if (const auto near = std::partition(nodes.begin(), nodes.end(), far); near != nodes.begin() && near != nodes.end())
        return std::size_t(near - nodes.begin());
    const std::size_t half = nodes.size() / 2;
    if (far(nodes[0])) return half;
    glm::vec3 lower(nodes[0].center), upper = lower;
    for (const LightNode& n : nodes) {
        lower = glm::min(lower, n.center);
        upper = glm::max(upper, n.center);
    }
    const glm::vec3 extent = upper - lower;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    if (!(extent[axis] > 0)) return half;
    constexpr int count = 16;
    struct Bin {
        glm::dvec3 lower{1e300}, upper{-1e300};
        double intensity = 0;
        void add(const Bin& b) {
            lower = glm::min(lower, b.lower);
            upper = glm::max(upper, b.upper);
            intensity += b.intensity;
        }
        double cost() const { return intensity > 0 ? intensity * glm::dot(upper - lower, upper - lower) : 0; }
    };
    std::array<Bin, count> bins, after;
    const auto bin_of = [&](const LightNode& n) {
        return std::min(count - 1, int((n.center[axis] - lower[axis]) / extent[axis] * count));
    };
    for (const LightNode& n : nodes)
        bins[std::size_t(bin_of(n))].add(
            {glm::dvec3(n.center) - double(n.radius), glm::dvec3(n.center) + double(n.radius), n.intensity});
    after[count - 1] = bins[count - 1];
    for (std::size_t i = count - 1; i-- > 0;) {
        after[i] = bins[i];
        after[i].add(after[i + 1]);
    }
    Bin before;
    double best = 1e300;
    int place = 0;
    for (int i = 1; i < count; ++i) {
        before.add(bins[std::size_t(i) - 1]);
        const double cost = before.cost() + after[std::size_t(i)].cost();
        if (before.intensity > 0 && after[std::size_t(i)].intensity > 0 && cost < best) {
            best = cost;
            place = i;
        }
    }
    const auto middle =
        std::partition(nodes.begin(), nodes.end(), [&](const LightNode& n) { return bin_of(n) < place; });
    const auto at = std::size_t(middle - nodes.begin());
    return at == 0 || at == nodes.size() ? half : at;
}

// Appends the children of the node `parent`, then theirs.
void place(std::vector<LightNode>& nodes, Nodes emitters, std::uint32_t parent) {
    std::vector<Nodes> groups{emitters};
    if (emitters.size() <= light_node_children) {
        groups.clear();
        for (std::size_t i = 0; i < emitters.size(); ++i)
            groups.push_back(emitters.subspan(i, 1));
    }
    while (groups.size() < light_node_children && emitters.size() > light_node_children) {
        const auto largest = std::ranges::max_element(groups, {}, &Nodes::size);
        const Nodes both = *largest;
        const std::size_t at = split(both);
        *largest = both.first(at);
        groups.push_back(both.subspan(at));
    }
    const auto first = std::uint32_t(nodes.size());
    if (parent != NONE) {
        nodes[parent].first = first;
        nodes[parent].count = std::uint32_t(groups.size());
    }
    for (const Nodes& group : groups) {
        LightNode node = group.size() == 1 ? group[0] : merged(group);
        node.parent = parent;
        nodes.push_back(node);
    }
    for (std::uint32_t i = 0; i < groups.size(); ++i)
        if (groups[i].size() > 1) place(nodes, groups[i], first + i);
}

} // namespace

LightTree make_light_tree(std::vector<LightNode> emitters) {
    LightTree tree;
    if (emitters.empty()) return tree;
    tree.nodes.reserve(emitters.size() + emitters.size() / 3 + 8);
    place(tree.nodes, emitters, NONE);
    while (tree.nodes.size() < light_node_children) // black: never chosen
        tree.nodes.push_back({.radius = -1, .parent = NONE});
    tree.roots = std::uint32_t(std::min<std::size_t>(emitters.size(), light_node_children));
    return tree;
}

void refit(LightNode& node, const LightNode* children) {
    std::vector<LightNode> copies(children, children + node.count);
    LightNode around = merged(copies);
    around.first = node.first;
    around.count = node.count;
    around.parent = node.parent;
    node = around;
}

} // namespace restage::render

// SPDX-License-Identifier: Apache-2.0
#include "query/triangle_tree.hpp"

#include <cmath>

namespace restage::query {

namespace {

constexpr std::uint32_t leaf = 4; // triangles

struct Box {
    glm::vec3 lower{std::numeric_limits<float>::infinity()}, upper{-std::numeric_limits<float>::infinity()};
    glm::vec3 middle() const { return 0.5f * (lower + upper); }
    void add(const glm::vec3& low, const glm::vec3& high) {
        lower = glm::min(lower, low);
        upper = glm::max(upper, high);
    }
};

Box box_of(const Triangle& t) { // rounded outwards
    const glm::dvec3 low = glm::min(glm::min(t[0], t[1]), t[2]), high = glm::max(glm::max(t[0], t[1]), t[2]);
    return {glm::vec3(low - 1.2e-7 * glm::abs(low)), glm::vec3(high + 1.2e-7 * glm::abs(high))};
}

} // namespace

TriangleTree::TriangleTree(std::shared_ptr<const scene::MeshData> mesh, const glm::dmat4& object_to_world)
    : mesh_(std::move(mesh)), place_(object_to_world) {
    const std::size_t all = mesh_->triangles.size();
    std::vector<Box> boxes(all);
    order_.reserve(all);
    for (std::uint32_t i = 0; i < all; ++i) {
        order_.push_back(i);
        const Triangle t = triangle(order_.size() - 1);
        const double area = glm::length(glm::cross(t[1] - t[0], t[2] - t[0]));
        if (area > 0 && std::isfinite(area))
            boxes[i] = box_of(t);
        else
            order_.pop_back();
    }
    if (order_.empty()) return;
    nodes_.reserve(order_.size());
    nodes_.push_back({.count = std::uint32_t(order_.size())});
    // Split where the middles of boxes are, in the middle of their longest side; else in halves.
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
        const std::uint32_t first = nodes_[n].first, count = nodes_[n].count;
        const auto begin = order_.begin() + first, end = begin + count;
        Box box, middles;
        for (auto i = begin; i != end; ++i) {
            box.add(boxes[*i].lower, boxes[*i].upper);
            middles.add(boxes[*i].middle(), boxes[*i].middle());
        }
        nodes_[n].lower = box.lower;
        nodes_[n].upper = box.upper;
        if (count <= leaf) continue;
        const glm::vec3 size = middles.upper - middles.lower;
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const float at = middles.middle()[axis];
        auto split = std::partition(begin, end, [&](std::uint32_t i) { return boxes[i].middle()[axis] < at; });
        if (split == begin || split == end) split = begin + count / 2;
        const auto left = std::uint32_t(split - begin);
        nodes_[n].first = std::uint32_t(nodes_.size());
        nodes_[n].count = 0;
        nodes_.push_back({.first = first, .count = left});
        nodes_.push_back({.first = first + left, .count = count - left});
    }
}

Triangle TriangleTree::triangle(std::size_t i) const {
    const glm::uvec3 t = mesh_->triangles[order_[i]];
    const auto corner = [&](std::uint32_t k) {
        return glm::dvec3(place_ * glm::dvec4(glm::dvec3(mesh_->positions[k]), 1));
    };
    return {corner(t.x), corner(t.y), corner(t.z)};
}

} // namespace restage::query

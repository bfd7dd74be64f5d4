// SPDX-License-Identifier: Apache-2.0
// Points in space: how far they are from each other, and PointGrid, which sorts them by the cells of a grid, hashed as
// kernels do it (shared/photon_data.h).
#pragma once

#include "shared/photon_data.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace restage::render {

// The distance of a point to its nth neighbour: the quantile of so many of the points. place(i): the position of point
// i.
template <class Place>
float spacing(std::size_t points, Place&& place, std::size_t nth, double quantile, std::size_t probes) {
    if (points == 0) return 0;
    nth = std::min(nth, points - 1);
    std::vector<float> distances(std::min(probes, points)), all(points);
    for (std::size_t k = 0; k < distances.size(); ++k) {
        const glm::vec3 p = place(k * points / distances.size());
        for (std::size_t i = 0; i < points; ++i) {
            const glm::vec3 d = place(i) - p;
            all[i] = glm::dot(d, d);
        }
        std::ranges::nth_element(all, all.begin() + std::ptrdiff_t(nth));
        distances[k] = std::sqrt(all[nth]);
    }
    const auto middle = distances.begin() + std::ptrdiff_t(quantile * double(distances.size() - 1));
    std::ranges::nth_element(distances, middle);
    return *middle;
}

struct PointGrid {
    float per_cell = 1; // 1 / side of a cell
    std::uint32_t mask = 0; // of hashes
    std::vector<std::uint32_t> first; // [mask + 2]: of each hash its first place in `order`
    std::vector<std::uint32_t> order; // indices of points; of one hash in their own order

    static std::uint32_t mask_for(std::size_t points) {
        return std::bit_ceil(std::max(std::uint32_t(points), 64u)) - 1;
    }

    template <class Place>
    PointGrid(std::size_t points, float cell, Place&& place) : PointGrid(points, mask_for(points), cell, place) {}
    template <class Place>
    PointGrid(std::size_t points, std::uint32_t hash_mask, float cell, Place&& place)
        : per_cell(1 / cell), mask(hash_mask), order(points) {
        first.resize(std::size_t(mask) + 2);
        std::vector<std::uint32_t> bucket(points);
        for (std::size_t i = 0; i < points; ++i) {
            bucket[i] = hash(cell_of(place(i)));
            ++first[bucket[i] + 1];
        }
        std::partial_sum(first.begin(), first.end(), first.begin());
        std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
        for (std::size_t i = 0; i < points; ++i)
            order[next[bucket[i]]++] = std::uint32_t(i);
    }

    glm::ivec3 cell_of(const glm::vec3& p) const { return glm::ivec3(glm::floor(p * per_cell)); }
    std::uint32_t hash(const glm::ivec3& c) const { return shared::photon_cell_hash(c.x, c.y, c.z) & mask; }

    // Calls f(i) once for each point of the 27 cells around p, and for some others.
    template <class F>
    void near(const glm::vec3& p, F&& f) const {
        const glm::ivec3 c = cell_of(p);
        std::array<std::uint32_t, 27> hashes{};
        for (int k = 0; k < 27; ++k)
            hashes[std::size_t(k)] = hash(c + glm::ivec3(k % 3, k / 3 % 3, k / 9) - 1);
        std::ranges::sort(hashes);
        const auto end = std::ranges::unique(hashes).begin();
        for (auto h = hashes.begin(); h != end; ++h)
            for (std::uint32_t i = first[*h]; i < first[*h + 1]; ++i)
                f(order[i]);
    }
};

} // namespace restage::render

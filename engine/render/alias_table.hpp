// SPDX-License-Identifier: Apache-2.0
// Alias table: draws an index with given weights in constant time. Walker 1977; Vose 1991.
#pragma once

#include "shared/scene_data.h"

#include <span>
#include <vector>

namespace restage::render {

// weights >= 0 and finite, computed in double. All zero gives an empty table.
inline std::vector<shared::AliasEntry> make_alias_table(std::span<const double> weights) {
    double sum = 0;
    for (double w : weights)
        sum += w;
    if (!(sum > 0)) return {};
    const std::size_t n = weights.size();
    std::vector<shared::AliasEntry> table(n);
    std::vector<double> q(n);
    std::vector<std::uint32_t> small, large;
    for (std::size_t i = 0; i < n; ++i) {
        table[i].pmf = float(weights[i] / sum);
        q[i] = weights[i] / sum * double(n);
        (q[i] < 1 ? small : large).push_back(std::uint32_t(i));
    }
    while (!small.empty() && !large.empty()) {
        const auto s = small.back(), l = large.back();
        small.pop_back();
        table[s].q = float(q[s]);
        table[s].alias = l;
        q[l] -= 1 - q[s];
        if (q[l] < 1) {
            large.pop_back();
            small.push_back(l);
        }
    }
    for (const auto* rest : {&small, &large}) // 1 up to rounding; but zero weights are never drawn
        for (auto i : *rest) {
            table[i].q = weights[i] > 0 ? 1.f : 0.f;
            table[i].alias = i;
        }
    if (!small.empty()) { // an index of weight 0 left over by rounding aliases a non-zero one
        std::uint32_t best = 0;
        for (std::uint32_t i = 0; i < n; ++i)
            if (weights[i] > weights[best]) best = i;
        for (auto i : small)
            if (weights[i] <= 0) table[i].alias = best;
    }
    return table;
}

} // namespace restage::render

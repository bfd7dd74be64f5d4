// SPDX-License-Identifier: Apache-2.0
// Inverse of a discrete distribution, in order: the index grows with the number that draws it, so that what is left of
// the number within the index is as well distributed as the number was. An alias table would deal the same numbers out
// at random. Guided by a table of starting points (Chen and Asau 1974), a draw takes constant time on average.
#pragma once

#include "shared/scene_data.h"

#include <cmath>
#include <span>
#include <vector>

namespace restage::render {

// weights >= 0 and finite, summed in double. All zero gives an empty table.
inline std::vector<shared::CdfEntry> make_cdf(std::span<const double> weights) {
    double sum = 0;
    for (double w : weights)
        sum += w;
    if (!(sum > 0)) return {};
    std::vector<shared::CdfEntry> table(weights.size());
    double below = 0;
    for (std::size_t i = 0; i < table.size(); ++i) {
        table[i].start = std::uint32_t(std::min(std::floor(below / sum * CDF_TOTAL), double(CDF_TOTAL)));
        below += weights[i];
    }
    for (std::size_t end = table.size(); end > 0 && !(weights[end - 1] > 0); --end)
        table[end - 1].start = CDF_TOTAL; // what rounding has left over is not theirs
    std::size_t i = 0;
    for (std::size_t k = 0; k < table.size(); ++k) {
        const std::uint64_t bits = (std::uint64_t(k) << 32) / table.size();
        while (i + 1 < table.size() && table[i + 1].start <= bits)
            ++i;
        table[k].guide = std::uint32_t(i);
    }
    return table;
}

// The probability of drawing index i, exactly what shaders draw.
inline double cdf_probability(std::span<const shared::CdfEntry> table, std::size_t i) {
    const std::uint32_t end = i + 1 < table.size() ? table[i + 1].start : CDF_TOTAL;
    return double(end - table[i].start) / CDF_TOTAL;
}

} // namespace restage::render

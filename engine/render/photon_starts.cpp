// SPDX-License-Identifier: Apache-2.0
#include "render/photon_starts.hpp"

#include "render/cdf_table.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace restage::render {
namespace {

constexpr double prior = 0.25; // seen photons, of twice as many, that each cell is thought to have had before

// A photon from cell k weighs 1 / p_k, and is seen with probability f_k; then the variance of the sum of those seen is
// least if p_k is proportional to the root of f_k.
std::vector<double> weights(std::size_t cells, std::span<const PhotonStarts::Try> tries) {
    std::vector<double> all(cells, 2 * prior), seen(cells, prior);
    for (const auto& t : tries)
        all[t.cell] += 1, seen[t.cell] += t.seen ? 1 : 0;
    for (std::size_t k = 0; k < cells; ++k)
        seen[k] = std::sqrt(seen[k] / all[k]);
    return seen;
}

// Photons seen with these weights, over those with equal ones.
double gain_of(std::span<const double> weights, std::span<const PhotonStarts::Try> tries) {
    double sum = 0, with = 0, without = 0;
    for (const double w : weights)
        sum += w;
    for (const auto& t : tries)
        if (t.seen) with += weights[t.cell] * double(weights.size()) / sum, without += 1;
    return without > 0 ? with / without : 1;
}

} // namespace

PhotonStarts::PhotonStarts(std::size_t sources) {
    if (sources > 1) rows = std::min(std::bit_ceil(std::uint32_t(std::min<std::size_t>(sources, 16))), 16u), side = 8;
    cdf = make_cdf(std::vector<double>(std::size_t(rows) * side * side, 1.0));
}

void PhotonStarts::learn(std::span<const Try> tries) {
    const std::size_t cells = cdf.size(), half = tries.size() / 2;
    cdf = make_cdf(weights(cells, tries));
    // Of each half with what the other one teaches.
    const auto one = tries.first(half), other = tries.subspan(half);
    gain = 0.5 * (gain_of(weights(cells, one), other) + gain_of(weights(cells, other), one));
}

} // namespace restage::render

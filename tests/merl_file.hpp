// SPDX-License-Identifier: Apache-2.0
// Files of the MERL format that tests write: a BRDF at the centres of the cells.
#pragma once

#include "base/file.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <functional>
#include <numbers>
#include <string>

namespace restage::test {

using MerlCounts = std::array<std::int32_t, 3>;
using MerlBrdf = std::function<double(double theta_h, double theta_d, double phi_d, int channel)>; // [1/sr]

inline constexpr std::array<double, 3> merl_scale{1.0 / 1500, 1.15 / 1500, 1.66 / 1500};

inline std::string merl_bytes(const MerlCounts& n, const MerlBrdf& f) {
    std::string bytes(reinterpret_cast<const char*>(n.data()), 12);
    bytes.reserve(12 + std::size_t(24) * n[0] * n[1] * n[2]);
    for (int c = 0; c < 3; ++c)
        for (int h = 0; h < n[0]; ++h)
            for (int d = 0; d < n[1]; ++d)
                for (int p = 0; p < n[2]; ++p) {
                    const double half_pi = std::numbers::pi / 2;
                    const double v = f(half_pi * std::pow((h + 0.5) / n[0], 2), half_pi * (d + 0.5) / n[1],
                                       2 * half_pi * (p + 0.5) / n[2], c) /
                                     merl_scale[static_cast<std::size_t>(c)];
                    bytes.append(reinterpret_cast<const char*>(&v), sizeof v);
                }
    return bytes;
}

} // namespace restage::test

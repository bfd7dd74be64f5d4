// SPDX-License-Identifier: Apache-2.0
// PhotonStarts: which of the numbers that choose a photon's source and aim bring it to where it is seen. Importance
// sampling of emission, as in Peter and Pietrek 1998, "Importance Driven Construction of Photon Maps", but by a table
// of the numbers.
#pragma once

#include "shared/scene_data.h"

#include <cstdint>
#include <span>
#include <vector>

namespace restage::render {

struct PhotonStarts {
    struct Try { // of a photon that was started
        std::uint32_t cell = 0;
        bool seen = false;
    };

    // Cells of the unit cube of these numbers: rows * side * side, the aim's first number fastest, the source's
    // slowest.
    std::uint32_t rows = 1, side = 16;
    std::vector<shared::CdfEntry> cdf; // over the cells
    double gain = 1; // photons that are seen, over those of equally likely cells

    explicit PhotonStarts(std::size_t sources = 1); // all cells are equally likely
    // From photons that were started with equally likely cells.
    void learn(std::span<const Try> tries);
};

} // namespace restage::render

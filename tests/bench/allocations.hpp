// SPDX-License-Identifier: Apache-2.0
// How often the program has called operator new.
#pragma once

#include <cstdint>

namespace restage::bench {

std::uint64_t allocations_made();

} // namespace restage::bench

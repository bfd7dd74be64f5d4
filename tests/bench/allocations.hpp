// SPDX-License-Identifier: Apache-2.0
// Number of calls of operator new by the program.
#pragma once

#include <cstdint>

namespace restage::bench {

std::uint64_t allocations_made();

} // namespace restage::bench

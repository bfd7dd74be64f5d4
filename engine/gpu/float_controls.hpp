// SPDX-License-Identifier: Apache-2.0
// Private to gpu/: asks a device's compiler to keep NaN, infinity and the sign of zero, which Vulkan otherwise lets it
// optimise away (Vulkan 1.3, "Floating-Point Controls"; SPIR-V 1.6, SignedZeroInfNanPreserve).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace restage::gpu {

// A copy of a SPIR-V module (1.4 or later) in which every entry point has the execution mode for 32-bit floats. The
// device must offer it (DeviceInfo::keeps_nan). Incomplete modules are returned unchanged.
std::vector<std::uint32_t> keep_nan(std::span<const std::uint32_t> words);

} // namespace restage::gpu

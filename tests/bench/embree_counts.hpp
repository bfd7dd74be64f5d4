// SPDX-License-Identifier: Apache-2.0
// How many acceleration structures the engine has asked Embree for; counted by the linker's wrap, see CMakeLists.txt.
#pragma once

#include <cstdint>

namespace restage::bench {
std::uint64_t embree_scenes_made();
}

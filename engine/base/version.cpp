// SPDX-License-Identifier: Apache-2.0
#include "version.hpp"

namespace restage {

const char* version() { return RESTAGE_VERSION; } // a definition of this file alone, by CMake

} // namespace restage

// SPDX-License-Identifier: Apache-2.0
#include "version.hpp"

namespace restage {

const char* version() { return RESTAGE_VERSION; } // defined by CMake for this file alone

} // namespace restage

// SPDX-License-Identifier: Apache-2.0
// The version of Restage, "0.1.0": project(VERSION) of CMakeLists.txt, where alone it is written.
#pragma once

namespace restage {

const char* version();

} // namespace restage

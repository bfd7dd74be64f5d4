// SPDX-License-Identifier: Apache-2.0
// The version of Restage, "0.1.0": from project(VERSION) in CMakeLists.txt, its only source.
#pragma once

namespace restage {

const char* version();

} // namespace restage

// SPDX-License-Identifier: Apache-2.0
// Paths of the sources and the build of these tests. Functions, not macros: only paths.cpp then differs from clone to
// clone, and a compiler cache serves all other objects.
#pragma once

#include <filesystem>

namespace restage::test {

const std::filesystem::path& source_dir(); // the root of the repository
const std::filesystem::path& build_dir(); // of this preset: its bin, lib and share

} // namespace restage::test

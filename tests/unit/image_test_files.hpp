// SPDX-License-Identifier: Apache-2.0
// Input and output folders of the image tests.
#pragma once

#include "paths.hpp"

#include <filesystem>
#include <random>
#include <string>
#include "temporary_folder.hpp"

namespace restage::test {

inline std::string data_image(const std::string& name) {
    return restage::test::source_dir().string() + "/tests/data/images/" + name;
}

} // namespace restage::test

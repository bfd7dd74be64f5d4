// SPDX-License-Identifier: Apache-2.0
#include "paths.hpp"

namespace restage::test {

const std::filesystem::path& source_dir() {
    static const std::filesystem::path folder = RESTAGE_SOURCE_DIR;
    return folder;
}

const std::filesystem::path& build_dir() {
    static const std::filesystem::path folder = RESTAGE_BINARY_DIR;
    return folder;
}

} // namespace restage::test

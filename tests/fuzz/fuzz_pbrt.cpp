// SPDX-License-Identifier: Apache-2.0
// libFuzzer on the pbrt importer. Run: fuzz_pbrt tests/data/pbrt -rss_limit_mb=2048
#include "fuzz_host.hpp"

#include <load.hpp>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
    restage::fuzz::import(data, size, ".pbrt", restage::pbrt::load);
    return 0;
}

// SPDX-License-Identifier: Apache-2.0
// libFuzzer on an importer of models: RESTAGE_FUZZ_IMPORTER is its namespace, RESTAGE_FUZZ_EXTENSION the file's
// extension. Run: fuzz_obj tests/data/models -rss_limit_mb=2048
#include "fuzz_host.hpp"

#include <load.hpp>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
    restage::fuzz::import(data, size, RESTAGE_FUZZ_EXTENSION, restage::RESTAGE_FUZZ_IMPORTER::load);
    return 0;
}

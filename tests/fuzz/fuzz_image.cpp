// SPDX-License-Identifier: Apache-2.0
// libFuzzer on the image decoders. Run: fuzz_image tests/data/images -rss_limit_mb=2048 -malloc_limit_mb=1024

#include "io/image_file_codecs.hpp"

#include <cstdint>

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char*>(data), size);
    (void)restage::io::decode_image_bytes(bytes);
    return 0;
}

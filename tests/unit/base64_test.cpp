// SPDX-License-Identifier: Apache-2.0
// base64: the examples of RFC 4648, 10; every byte at every position; invalid input.
#include "base/base64.hpp"

#include <catch2/catch_test_macros.hpp>

using namespace restage;

TEST_CASE("base64 is that of RFC 4648", "[base]") {
    const std::pair<const char*, const char*> examples[] = {{"", ""},
                                                            {"f", "Zg=="},
                                                            {"fo", "Zm8="},
                                                            {"foo", "Zm9v"},
                                                            {"foob", "Zm9vYg=="},
                                                            {"fooba", "Zm9vYmE="},
                                                            {"foobar", "Zm9vYmFy"}};
    for (const auto& [bytes, text] : examples) {
        CHECK(encode_base64(bytes) == text);
        CHECK(decode_base64(text) == bytes);
    }
    for (int first = 0; first < 4; ++first) {
        std::string all(static_cast<std::size_t>(first), 'x');
        for (int i = 0; i < 256; ++i)
            all += static_cast<char>(i);
        CHECK(decode_base64(encode_base64(all)) == all);
    }
}

TEST_CASE("invalid base64 is refused", "[base]") {
    for (const char* text : {"Z", "Zg", "Zg=", "Zm9", "Z===", "Zm9v\n", "Zm 9v===", "Zm-_", "=Zm9", "Zm=v"})
        CHECK_FALSE(decode_base64(text));
}

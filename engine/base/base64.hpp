// SPDX-License-Identifier: Apache-2.0
// Bytes as text: base64 (RFC 4648, 4), with padding and without line breaks.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace restage {

std::string encode_base64(std::string_view bytes);
std::optional<std::string> decode_base64(std::string_view text); // nullopt if it is not base64

} // namespace restage

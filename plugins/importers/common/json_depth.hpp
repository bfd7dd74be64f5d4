// SPDX-License-Identifier: Apache-2.0
// Checks how deep JSON is nested, before a recursive reader reads it.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace restage::importing {

// The byte at which [ and { outside strings are nested deeper than `most`, if any. Accepts any text.
inline std::optional<std::size_t> too_deep_json(std::string_view text, std::size_t most) {
    std::size_t depth = 0;
    bool in_string = false;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const char c = text[at];
        if (in_string) {
            if (c == '\\') ++at;
            in_string = c != '"';
        } else if (c == '"') {
            in_string = true;
        } else if ((c == '[' || c == '{') && ++depth > most) {
            return at;
        } else if ((c == ']' || c == '}') && depth > 0) {
            --depth;
        }
    }
    return std::nullopt;
}

} // namespace restage::importing

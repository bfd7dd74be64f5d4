// SPDX-License-Identifier: Apache-2.0
// Reading untrusted JSON. The library's parser does not recurse, but operations on its
// values (copies, comparisons, output, readers built on it) do: text nested too deep would overflow the stack.
#pragma once

#include "base/result.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace restage {

// Deeper nesting is refused; nothing this program reads is nested a tenth as deep.
inline constexpr std::size_t most_json_depth = 256;

// The byte at which the nesting of [ and { outside strings exceeds `most`, if it does. Never fails, whatever the text.
std::optional<std::size_t> too_deep_json(std::string_view text, std::size_t most = most_json_depth);

// "3:17" for a byte offset in a text; columns count bytes.
std::string line_and_column(std::string_view text, std::size_t byte);

// Json: nlohmann::json or ordered_json. Errors: "3:17: not JSON: syntax error ...", to follow "file:".
template <class Json>
Result<Json> parse_json(std::string_view text) {
    if (const auto at = too_deep_json(text))
        return fail(line_and_column(text, *at) + ": JSON nested more than " + std::to_string(most_json_depth) +
                    " deep is not read");
    try {
        return Json::parse(text);
    } catch (const typename Json::parse_error& e) {
        const std::string what = e.what(); // "[json.exception.parse_error.101] parse error at line 1, column 2: ..."
        const std::size_t colon = what.find(": ");
        return fail(line_and_column(text, e.byte ? e.byte - 1 : 0) +
                    ": not JSON: " + (colon == std::string::npos ? what : what.substr(colon + 2)));
    }
}

} // namespace restage

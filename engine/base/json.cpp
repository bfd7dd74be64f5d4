// SPDX-License-Identifier: Apache-2.0
#include "base/json.hpp"

#include <algorithm>

namespace restage {

std::optional<std::size_t> too_deep_json(std::string_view text, std::size_t most) {
    std::size_t depth = 0;
    for (std::size_t at = 0; at < text.size(); ++at) {
        switch (text[at]) {
            case '"': // a string: brackets inside are ignored
                for (++at; at < text.size() && text[at] != '"'; ++at)
                    if (text[at] == '\\') ++at;
                break;
            case '[':
            case '{':
                if (++depth > most) return at;
                break;
            case ']':
            case '}':
                if (depth > 0) --depth;
                break;
            default:
                break;
        }
    }
    return std::nullopt;
}

std::string line_and_column(std::string_view text, std::size_t byte) {
    const std::string_view before = text.substr(0, std::min(byte, text.size()));
    const auto line = std::count(before.begin(), before.end(), '\n') + 1;
    const std::size_t start = before.rfind('\n');
    const std::size_t column = before.size() - (start == before.npos ? 0 : start + 1) + 1;
    return std::to_string(line) + ":" + std::to_string(column);
}

} // namespace restage

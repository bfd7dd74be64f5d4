// SPDX-License-Identifier: Apache-2.0
#include "common/text.hpp"

#include <algorithm>
#include <charconv>

namespace restage::exporters {

namespace {

template <class T>
std::string shortest(T value) {
    char text[64];
    const auto [end, code] = std::to_chars(text, text + sizeof text, value);
    return std::string(text, end);
}

} // namespace

std::string number(float value) { return shortest(value); }
std::string number(double value) { return shortest(value); }

std::string plain_name(std::string_view text) {
    std::string out(text);
    for (char& c : out)
        if (static_cast<unsigned char>(c) < 32 || c == '"' || c == '/' || c == '\\' || c == ':' || c == '*' ||
            c == '?' || c == '<' || c == '>' || c == '|')
            c = '_';
    return out;
}

std::vector<std::string> lines(std::string_view text) {
    std::vector<std::string> out;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        if (end > 0) out.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return out;
}

} // namespace restage::exporters

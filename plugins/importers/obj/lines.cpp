// SPDX-License-Identifier: Apache-2.0
#include "lines.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace restage::obj {

namespace {
constexpr std::string_view blanks = " \t\v\f";
}

Statements::Statements(std::string_view text) : text_(text) {
    if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;
}

std::string_view Statements::line() {
    const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
    const std::string_view result = text_.substr(at_, end - at_);
    at_ = std::min(end + (text_.substr(end, 2) == "\r\n" ? 2 : 1), text_.size());
    ++number_;
    return result;
}

bool Statements::next(Statement& out) {
    while (at_ < text_.size()) {
        std::string_view all = line();
        out.line = number_;
        const auto goes_on = [](std::string_view part) { // tolerates blanks after the backslash
            const std::size_t last = part.find_last_not_of(blanks);
            return last != part.npos && part[last] == '\\' ? last : part.npos;
        };
        if (std::size_t slash = goes_on(all); slash != all.npos && !all.substr(0, slash).starts_with('#')) {
            joined_ = all.substr(0, slash);
            while (slash != all.npos && at_ < text_.size()) {
                all = line();
                slash = goes_on(all);
                joined_ += ' ';
                joined_ += all.substr(0, slash);
            }
            all = joined_;
        }
        const std::size_t start = all.find_first_not_of(blanks);
        if (start == all.npos || all[start] == '#') continue;
        const std::size_t word_end = std::min(all.find_first_of(blanks, start), all.size());
        const std::size_t rest = std::min(all.find_first_not_of(blanks, word_end), all.size());
        out.word = all.substr(start, word_end - start);
        out.rest = all.substr(rest);
        out.rest.remove_suffix(out.rest.size() - (out.rest.find_last_not_of(blanks) + 1));
        out.column = static_cast<std::uint32_t>(rest + 1);
        return true;
    }
    return false;
}

std::optional<std::string_view> Words::next() {
    const std::size_t start = rest_.find_first_not_of(blanks, at_);
    if (start == rest_.npos || rest_[start] == '#') return std::nullopt;
    start_ = start;
    at_ = std::min(rest_.find_first_of(blanks, start), rest_.size());
    return rest_.substr(start, at_ - start);
}

std::string_view Words::remainder() const {
    const std::size_t start = rest_.find_first_not_of(blanks, at_);
    return start == rest_.npos ? std::string_view() : rest_.substr(start);
}

std::optional<double> number(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end != word.data() + word.size() || word.empty()) return std::nullopt;
    const bool tiny =
        problem == std::errc::result_out_of_range && (word.find("e-") != word.npos || word.find("E-") != word.npos);
    if (tiny) return 0;
    return problem == std::errc() && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

} // namespace restage::obj

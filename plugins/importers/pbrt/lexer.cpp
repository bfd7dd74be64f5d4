// SPDX-License-Identifier: Apache-2.0
#include "lexer.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace restage::pbrt {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v'; }
bool ends_word(char c) { return is_blank(c) || c == '"' || c == '[' || c == ']' || c == '#'; }
bool starts_number(char c) { return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.'; }

std::string quoted(std::string_view text) {
    constexpr std::size_t longest = 60;
    std::string out = "'";
    for (const char c : text.substr(0, longest))
        out += static_cast<unsigned char>(c) < 32 || c == 127 ? '?' : c;
    return out + (text.size() > longest ? "...'" : "'");
}

} // namespace

namespace {

// About the power of ten of a decimal number: only huge or tiny matters. Saturates.
long long power_of_ten(std::string_view text) {
    constexpr long long most = 1'000'000'000'000;
    const std::size_t e = std::min(text.find_first_of("eE"), text.size());
    std::string_view mantissa = text.substr(0, e), exponent = text.substr(std::min(e + 1, text.size()));
    if (exponent.starts_with('+')) exponent.remove_prefix(1);
    long long power = 0;
    if (std::from_chars(exponent.data(), exponent.data() + exponent.size(), power).ec == std::errc::result_out_of_range)
        power = exponent.starts_with('-') ? -most : most;
    power = std::clamp(power, -most, most);
    const std::size_t digit = mantissa.find_first_of("123456789"),
                      point = std::min(mantissa.find('.'), mantissa.size());
    return power + static_cast<long long>(point) - static_cast<long long>(std::min(digit, mantissa.size()));
}

} // namespace

double parse_number(std::string_view text, Location at) {
    const char* begin = text.data();
    const char* end = begin + text.size();
    if (begin != end && *begin == '+') ++begin;
    double value = 0;
    const auto [stop, code] = std::from_chars(begin, end, value);
    if (stop == end && begin != end && code == std::errc::result_out_of_range) {
        // from_chars reports 1e-400 and 1e400 alike; only the first is harmless.
        if (power_of_ten(text) < 0) return text.starts_with('-') ? -0.0 : 0.0;
        throw ImportError{at, "number " + quoted(text) + " is too large for a double; write a smaller one"};
    }
    if (stop != end || begin == end || code != std::errc())
        throw ImportError{at, "expected a number, found " + quoted(text)};
    if (!std::isfinite(value))
        throw ImportError{at, "number " + quoted(text) + " is not finite; scene files may hold finite numbers only"};
    return value;
}

void Lexer::push(std::uint32_t file, bool included) {
    const std::string_view text = sources_.text(file);
    Frame frame{
        .file = file, .at = text.data(), .end = text.data() + text.size(), .line_start = text.data(), .line = 1};
    frame.included = included;
    if (text.starts_with("\xEF\xBB\xBF")) { // a byte order mark
        frame.at += 3;
        frame.line_start += 3;
    }
    frames_.push_back(frame);
}

bool Lexer::is_open(const std::string& name) const {
    for (const Frame& frame : frames_)
        if (sources_.name(frame.file) == name) return true;
    return false;
}

Location Lexer::place(const Frame& frame, const char* at) const {
    return {frame.file, frame.line, static_cast<std::uint32_t>(at - frame.line_start) + 1};
}

// At '#': takes the comment, or only its mark if the rest is for us.
void Lexer::skip_comment(Frame& frame) {
    constexpr std::string_view mark = "#restage ";
    const bool own_line = std::all_of(frame.ours_from ? frame.ours_from : frame.line_start, frame.at, is_blank);
    if (own_line && std::string_view(frame.at, static_cast<std::size_t>(frame.end - frame.at)).starts_with(mark)) {
        frame.at += mark.size();
        frame.ours_from = frame.at;
        return;
    }
    const char* begin = frame.at + 1;
    while (frame.at != frame.end && *frame.at != '\n' && *frame.at != '\r')
        ++frame.at;
    if (own_line) comments_.emplace_back(begin, static_cast<std::size_t>(frame.at - begin));
}

void Lexer::skip_blanks(Frame& frame) {
    while (frame.at != frame.end) {
        const char c = *frame.at;
        if (c == '\n' || (c == '\r' && (frame.at + 1 == frame.end || frame.at[1] != '\n'))) {
            ++frame.line;
            frame.line_start = frame.at + 1;
            frame.ours_from = nullptr;
        } else if (c == '#') {
            skip_comment(frame);
            continue;
        } else if (!is_blank(c)) {
            return;
        }
        ++frame.at;
    }
}

Token Lexer::next() {
    if (has_peeked_) {
        has_peeked_ = false;
        return peeked_;
    }
    return scan();
}

const Token& Lexer::peek() {
    if (!has_peeked_) {
        peeked_ = scan();
        has_peeked_ = true;
    }
    return peeked_;
}

Location Lexer::here() { return peek().at; }

bool Lexer::leave_included() {
    if (!frames_.back().included || frames_.size() < 2) return false;
    frames_.pop_back();
    return true;
}

double Lexer::number_in(const Token& word) {
    const char* begin = word.text.data();
    const char* end = begin + word.text.size();
    double value = 0;
    const char* number = begin != end && *begin == '+' ? begin + 1 : begin;
    const auto [stop, code] = std::from_chars(number, end, value);
    if (code != std::errc() || stop == end || stop == number || !std::isfinite(value))
        return parse_number(word.text, word.at); // in full, or throws
    slips_.push_back({word.at, "number " + quoted(word.text),
                      "pbrt reads " + std::string(begin, stop) + " and leaves the rest out; separate numbers by spaces",
                      false});
    return value;
}

bool Lexer::number(double& value) {
    if (has_peeked_) {
        if (peeked_.kind != TokenKind::word || !starts_number(peeked_.text.front())) return false;
        has_peeked_ = false;
        value = number_in(peeked_);
        return true;
    }
    do {
        skip_blanks(frames_.back());
    } while (frames_.back().at == frames_.back().end && leave_included());
    Frame& frame = frames_.back();
    if (frame.at == frame.end || !starts_number(*frame.at)) return false;
    const char* begin = *frame.at == '+' ? frame.at + 1 : frame.at;
    const auto [stop, code] = std::from_chars(begin, frame.end, value);
    if (code == std::errc() && (stop == frame.end || ends_word(*stop)) && std::isfinite(value)) {
        frame.at = stop;
        return true;
    }
    value = number_in(scan()); // reports the error
    return true;
}

Token Lexer::scan() {
    do {
        skip_blanks(frames_.back());
    } while (frames_.back().at == frames_.back().end && leave_included());
    Frame& frame = frames_.back();
    const Location at = place(frame, frame.at);
    const bool ours = frame.ours_from != nullptr;
    if (frame.at == frame.end) return {TokenKind::end_of_file, {}, at, ours};
    const char c = *frame.at;
    if (c == '[') return {TokenKind::open, {frame.at++, 1}, at, ours};
    if (c == ']') return {TokenKind::close, {frame.at++, 1}, at, ours};
    if (c == '"') return scan_text(frame);
    const char* begin = frame.at;
    while (frame.at != frame.end && !ends_word(*frame.at))
        ++frame.at;
    return {TokenKind::word, {begin, static_cast<std::size_t>(frame.at - begin)}, at, ours};
}

Token Lexer::scan_text(Frame& frame) {
    const Location at = place(frame, frame.at);
    const char* begin = ++frame.at;
    bool escapes = false;
    while (frame.at != frame.end && *frame.at != '"') {
        if (*frame.at == '\n') throw ImportError{at, "this string is not closed on its line; add the missing '\"'"};
        if (*frame.at == '\\' && frame.at + 1 != frame.end && frame.at[1] != '\n') {
            escapes = true;
            ++frame.at;
        }
        ++frame.at;
    }
    if (frame.at == frame.end)
        throw ImportError{at, "the file ends inside this string; add the missing '\"' or restore the rest of the file"};
    const std::string_view raw{begin, static_cast<std::size_t>(frame.at++ - begin)};
    const bool ours = frame.ours_from != nullptr;
    return {TokenKind::text, escapes ? std::string_view(unescaped_.emplace_back(unescape(raw))) : raw, at, ours};
}

std::string unescape(std::string_view raw) {
    std::string out;
    for (std::size_t i = 0; i < raw.size(); ++i) {
        if (raw[i] != '\\' || i + 1 == raw.size()) {
            out += raw[i];
            continue;
        }
        const char next = raw[++i];
        switch (next) {
            case 'b':
                out += '\b';
                break;
            case 'f':
                out += '\f';
                break;
            case 'n':
                out += '\n';
                break;
            case 'r':
                out += '\r';
                break;
            case 't':
                out += '\t';
                break;
            case '\\':
            case '\'':
            case '"':
                out += next;
                break;
            default:
                (out += '\\') += next; // "textures\wood.png": a Windows path, not an escape
        }
    }
    return out;
}

} // namespace restage::pbrt

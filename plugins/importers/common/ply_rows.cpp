// SPDX-License-Identifier: Apache-2.0
#include "common/ply_rows.hpp"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>

namespace restage::importing {

namespace {

template <class T>
double load(const char* from, bool swap) {
    T value;
    if (swap) {
        char bytes[sizeof(T)];
        for (std::size_t i = 0; i < sizeof(T); ++i)
            bytes[i] = from[sizeof(T) - 1 - i];
        std::memcpy(&value, bytes, sizeof(T));
    } else {
        std::memcpy(&value, from, sizeof(T));
    }
    return static_cast<double>(value);
}

double load_number(PlyType type, const char* from, bool swap) {
    switch (type) {
        case PlyType::i8:
            return load<std::int8_t>(from, swap);
        case PlyType::u8:
            return load<std::uint8_t>(from, swap);
        case PlyType::i16:
            return load<std::int16_t>(from, swap);
        case PlyType::u16:
            return load<std::uint16_t>(from, swap);
        case PlyType::i32:
            return load<std::int32_t>(from, swap);
        case PlyType::u32:
            return load<std::uint32_t>(from, swap);
        case PlyType::f32:
            return load<float>(from, swap);
        default:
            return load<double>(from, swap);
    }
}

} // namespace

PlyRows::PlyRows(std::string_view bytes, const PlyHeader& header)
    : bytes_(bytes),
      ascii_(header.format == PlyFormat::ascii),
      swap_(header.format == (std::endian::native == std::endian::little ? PlyFormat::big : PlyFormat::little)),
      position_(header.size),
      last_(header.size) {}

void PlyRows::fail(const std::string& what) const {
    if (!ascii_) throw PlyProblem{what, 0, last_};
    const std::string_view before = bytes_.substr(0, last_);
    const auto feeds = std::count(before.begin(), before.end(), '\n');
    const auto returns = feeds > 0 ? 0 : std::count(before.begin(), before.end(), '\r');
    throw PlyProblem{what, static_cast<std::uint32_t>(1 + feeds + returns), 0};
}

std::string PlyRows::shortest(double value) {
    if (value == std::floor(value) && std::abs(value) < 1e15) return std::to_string(static_cast<std::int64_t>(value));
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

void PlyRows::check_count(const PlyElement& element) const {
    std::size_t row = 0;
    for (const PlyProperty& property : element.properties)
        row += ascii_ ? 2 : (property.is_list ? size_of(property.count_type) : size_of(property.type));
    // The last number of an ascii file may lack the trailing blank.
    if (row > 0 && element.count > (left() + 1) / row)
        fail(std::to_string(element.count) + " '" + element.name +
             "' elements are declared, but the file ends before them (truncated?)");
    if (row == 0 && element.count > 0 && element.properties.empty()) return;
    if (element.count > 0xffffffffu) fail("more than 2^32 '" + element.name + "' elements");
}

double PlyRows::ascii_number() {
    while (position_ < bytes_.size() && static_cast<unsigned char>(bytes_[position_]) <= ' ')
        ++position_;
    last_ = position_;
    const char* begin = bytes_.data() + position_;
    const char* end = bytes_.data() + bytes_.size();
    if (begin == end) fail("the file ends early (truncated?)");
    if (*begin == '+') ++begin;
    double value = 0;
    const auto [stop, code] = std::from_chars(begin, end, value);
    if (code == std::errc::result_out_of_range)
        value = 0; // 1e-400; 1e400 becomes a visibly wrong point
    else if (code != std::errc())
        fail("'" + std::string(begin, std::min<std::size_t>(20, static_cast<std::size_t>(end - begin))) +
             "' is not a number");
    position_ = static_cast<std::size_t>(stop - bytes_.data());
    return value;
}

double PlyRows::number(PlyType type) {
    if (ascii_) return ascii_number();
    last_ = position_;
    if (left() < size_of(type)) fail("the file ends early (truncated?)");
    const double value = load_number(type, bytes_.data() + position_, swap_);
    position_ += size_of(type);
    return value;
}

std::size_t PlyRows::list_count(const PlyProperty& property) {
    const double count = number(property.count_type);
    if (!(count >= 0) || count != std::floor(count)) fail("a list has " + shortest(count) + " entries");
    const double least = ascii_ ? 1 : double(size_of(property.type));
    if (count * least > double(left()) + 1)
        fail("a list of " + shortest(count) + " entries does not fit into the file (truncated?)");
    return static_cast<std::size_t>(count);
}

void PlyRows::skip(const PlyProperty& property) {
    const std::size_t n = property.is_list ? list_count(property) : 1;
    for (std::size_t k = 0; k < n; ++k)
        number(property.type);
}

const char* PlyRows::plain(const PlyElement& element) {
    if (!is_plain(element) || element.count == 0) return nullptr;
    const char* rows = bytes_.data() + position_;
    last_ = position_;
    position_ += element.count * element.stride; // check_count has checked that they exist
    return rows;
}

double PlyRows::load(PlyType type, const char* from) const { return load_number(type, from, swap_); }

bool PlyRows::take_plain_triangle(std::uint32_t (&corners)[3]) {
    if (ascii_ || swap_ || left() < 13 || bytes_[position_] != 3) return false;
    std::memcpy(corners, bytes_.data() + position_ + 1, sizeof corners);
    last_ = position_;
    position_ += 13;
    return true;
}

} // namespace restage::importing

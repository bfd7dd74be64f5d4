// SPDX-License-Identifier: Apache-2.0
#include "common/ply_header.hpp"

#include <charconv>
#include <map>
#include <optional>

namespace restage::importing {

namespace {

std::optional<PlyType> type_named(std::string_view name) {
    static const std::map<std::string_view, PlyType> names = {
        {"char", PlyType::i8},   {"int8", PlyType::i8},     {"uchar", PlyType::u8},   {"uint8", PlyType::u8},
        {"short", PlyType::i16}, {"int16", PlyType::i16},   {"ushort", PlyType::u16}, {"uint16", PlyType::u16},
        {"int", PlyType::i32},   {"int32", PlyType::i32},   {"uint", PlyType::u32},   {"uint32", PlyType::u32},
        {"float", PlyType::f32}, {"float32", PlyType::f32}, {"double", PlyType::f64}, {"float64", PlyType::f64}};
    const auto found = names.find(name);
    return found == names.end() ? std::nullopt : std::optional(found->second);
}

class HeaderReader {
  public:
    explicit HeaderReader(std::string_view bytes) : bytes_(bytes) {}

    PlyHeader read() {
        if (words(line()) != std::vector<std::string_view>{"ply"})
            fail("it is not a PLY file (the first line is not 'ply')");
        bool has_format = false;
        while (true) {
            const auto part = words(line());
            if (part.size() > 2 && part[0] == "comment" && part[1] == "TextureFile") // the name may have blanks
                header_.textures.emplace_back(part[2].data(), part.back().data() + part.back().size());
            if (part.empty() || part[0] == "comment" || part[0] == "obj_info") continue;
            if (part[0] == "end_header") break;
            if (part[0] == "format" && part.size() >= 2) {
                has_format = true;
                if (part[1] == "ascii")
                    header_.format = PlyFormat::ascii;
                else if (part[1] == "binary_little_endian")
                    header_.format = PlyFormat::little;
                else if (part[1] == "binary_big_endian")
                    header_.format = PlyFormat::big;
                else
                    fail("format '" + std::string(part[1]) + "' is unknown");
            } else if (part[0] == "element" && part.size() == 3) {
                PlyElement element{.name = std::string(part[1]), .properties = {}};
                const auto [end, code] =
                    std::from_chars(part[2].data(), part[2].data() + part[2].size(), element.count);
                if (code != std::errc() || end != part[2].data() + part[2].size())
                    fail("the number of '" + element.name + "' elements is not readable");
                header_.elements.push_back(std::move(element));
            } else if (part[0] == "property" && !header_.elements.empty() &&
                       (part.size() == 3 || (part.size() == 5 && part[1] == "list"))) {
                PlyElement& element = header_.elements.back();
                PlyProperty property{.name = std::string(part.back())};
                property.is_list = part.size() == 5;
                const auto type = type_named(part[part.size() - 2]);
                const auto count_type = property.is_list ? type_named(part[2]) : type;
                if (!type || !count_type) fail("property '" + property.name + "' has an unknown type");
                property.type = *type;
                property.count_type = *count_type;
                property.offset = element.stride;
                element.stride += size_of(*type);
                element.has_lists |= property.is_list;
                element.properties.push_back(std::move(property));
            } else {
                fail("header line '" + std::string(part[0].substr(0, 40)) + " ...' is not understood");
            }
        }
        if (!has_format) fail("the header names no format");
        return std::move(header_);
    }

  private:
    [[noreturn]] void fail(const std::string& what) const { throw PlyProblem{what, line_, 0}; }

    // Lines end as the first one does: \n, \r\n or \r; what follows the header may begin with either.
    std::string_view line() {
        ++line_;
        const std::size_t end = bytes_.find_first_of(end_.empty() ? "\r\n" : end_.substr(0, 1), header_.size);
        if (end == bytes_.npos) fail("the header does not end");
        if (end_.empty()) end_ = bytes_[end] == '\n' ? "\n" : bytes_.substr(end, 2) == "\r\n" ? "\r\n" : "\r";
        const std::string_view text = bytes_.substr(header_.size, end - header_.size);
        header_.size = end + 1;
        if (end_.size() == 2 && bytes_.substr(end, 2) == end_) ++header_.size;
        return text.ends_with('\r') ? text.substr(0, text.size() - 1) : text;
    }

    static std::vector<std::string_view> words(std::string_view text) {
        std::vector<std::string_view> out;
        while (true) {
            const auto begin = text.find_first_not_of(" \t");
            if (begin == text.npos) return out;
            const auto end = std::min(text.find_first_of(" \t", begin), text.size());
            out.push_back(text.substr(begin, end - begin));
            text.remove_prefix(end);
        }
    }

    std::string_view bytes_;
    std::string_view end_{};
    std::uint32_t line_ = 0;
    PlyHeader header_;
};

} // namespace

std::string PlyProblem::sentence() const {
    if (line > 0) return "line " + std::to_string(line) + ": " + what;
    return byte > 0 ? "byte " + std::to_string(byte) + ": " + what : what;
}

std::size_t size_of(PlyType type) {
    constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[static_cast<int>(type)];
}

PlyHeader read_ply_header(std::string_view bytes) { return HeaderReader(bytes).read(); }

} // namespace restage::importing

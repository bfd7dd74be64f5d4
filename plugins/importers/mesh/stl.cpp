// SPDX-License-Identifier: Apache-2.0
#include "stl.hpp"

#include "common/error.hpp"
#include "common/large_coordinates.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <unordered_map>

namespace restage::mesh {

using namespace importing;

namespace {

constexpr std::size_t header = 84, facet = 50;

using Point = std::array<double, 3>;

struct PointHash {
    std::size_t operator()(const Point& p) const {
        std::uint64_t h = 0;
        for (const double x : p) {
            std::uint64_t bits = 0;
            std::memcpy(&bits, &x, 8);
            h = (h ^ bits) * 0x9e3779b97f4a7c15ull, h ^= h >> 29;
        }
        return static_cast<std::size_t>(h);
    }
};

class Welder {
  public:
    void add(Point p) {
        for (double& x : p)
            x += 0.; // -0 is 0
        const auto [it, fresh] = known_.try_emplace(p, static_cast<std::uint32_t>(known_.size()));
        if (fresh) positions_.insert(positions_.end(), p.begin(), p.end());
        indices_.push_back(it->second);
    }
    void finish(Stl& out) {
        out.mesh.positions = recentred(positions_, out.origin);
        out.mesh.indices = std::move(indices_);
    }

  private:
    std::vector<double> positions_;
    std::vector<std::uint32_t> indices_;
    std::unordered_map<Point, std::uint32_t, PointHash> known_;
};

std::uint32_t facet_count(std::string_view bytes) { // little-endian, like the supported machines
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + header - 4, 4);
    return count;
}

// The format leaves two bytes after each facet unused. VisCAM and SolidView: 15 bits blue, green, red from the
// lowest on, valid where the highest is set. Magics, whose header has "COLOR=" and a colour for the rest: red, green,
// blue, and valid where it is not.
class FacetColors {
  public:
    explicit FacetColors(std::string_view head) {
        const std::size_t at = head.find("COLOR=");
        magics_ = at != head.npos && at + 9 < head.size();
        for (std::size_t c = 0; magics_ && c < 3; ++c)
            rest_[c] = static_cast<float>(static_cast<unsigned char>(head[at + 6 + c])) / 255;
    }
    void add(std::uint16_t bits) {
        any_ |= magics_ || bits != 0;
        const bool own = (bits >> 15 != 0) != magics_;
        valid_ += own;
        for (unsigned c = 0; c < 3; ++c) {
            const unsigned shift = magics_ ? 5 * c : 10 - 5 * c;
            colors_.push_back(own ? static_cast<float>(bits >> shift & 31) / 31 : rest_[c]);
        }
    }
    void finish(Stl& out) {
        if (valid_ > 0 || magics_)
            out.colors = std::move(colors_);
        else if (any_)
            out.notes.emplace_back("facets have attribute bytes that are not colours; they are not read");
    }

  private:
    bool magics_ = false, any_ = false;
    std::size_t valid_ = 0;
    std::array<float, 3> rest_{0.5f, 0.5f, 0.5f};
    std::vector<float> colors_;
};

Stl read_binary(std::string_view bytes) {
    if (bytes.size() < header) throw ImportError{"byte " + std::to_string(bytes.size()) + ": the header ends early"};
    const std::size_t found = (bytes.size() - header) / facet;
    std::size_t count = facet_count(bytes);
    Stl result;
    if (count == 0 && found > 0 && bytes.size() == header + found * facet) { // written before the count was known
        result.notes.emplace_back("the header declares no facets; the " + std::to_string(found) +
                                  " that follow are read");
        count = found;
    }
    if (found < count)
        throw ImportError{"byte " + std::to_string(bytes.size()) + ": the file is cut: " + std::to_string(count) +
                          " facets declared, " + std::to_string(found) + " found"};
    if (const std::size_t rest = bytes.size() - header - count * facet; rest > 0 && count > 0)
        result.notes.emplace_back(std::to_string(rest) + " bytes behind the last facet are not read");
    Welder welder;
    FacetColors colors(bytes.substr(0, header - 4));
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::size_t at = header + i * facet + 12 * (corner + 1); // after the normal
            std::array<float, 3> p{};
            std::memcpy(p.data(), bytes.data() + at, 12);
            if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
                throw ImportError{"byte " + std::to_string(at) + ": a vertex is not finite"};
            welder.add({double(p[0]), double(p[1]), double(p[2])});
        }
        std::uint16_t bits = 0;
        std::memcpy(&bits, bytes.data() + header + i * facet + 48, 2);
        colors.add(bits);
    }
    welder.finish(result);
    colors.finish(result);
    return result;
}

bool same(std::string_view word, std::string_view lower) { // in any case
    if (word.size() != lower.size()) return false;
    for (std::size_t i = 0; i < word.size(); ++i)
        if ((word[i] | 32) != lower[i]) return false;
    return true;
}

// Words with their places.
class Words {
  public:
    explicit Words(std::string_view text) : text_(text) {}
    std::string_view next() {
        while (at_ < text_.size() && std::strchr(" \t\r\n", text_[at_]))
            step();
        line = line_, column = column_;
        const std::size_t start = at_;
        while (at_ < text_.size() && !std::strchr(" \t\r\n", text_[at_]))
            step();
        return text_.substr(start, at_ - start);
    }
    // The name after "solid" or "endsolid": to the end of the line, but no further than the statement that may follow
    // on it ("facet normal", "endsolid", "solid").
    void skip_name() {
        while (at_ < text_.size() && !std::strchr("\r\n", text_[at_])) {
            const Words before = *this;
            const std::string_view word = next();
            if (word.empty() || line > before.line_) {
                *this = before;
                skip_blanks();
                return;
            }
            Words behind = *this;
            if (same(word, "endsolid") || same(word, "solid") ||
                (same(word, "facet") && same(behind.next(), "normal"))) {
                *this = before;
                return;
            }
        }
    }
    [[noreturn]] void fail(const std::string& what) const { throw ImportError{what, line, column}; }
    std::uint32_t line = 1, column = 1; // of the last word

  private:
    void skip_blanks() {
        while (at_ < text_.size() && std::strchr(" \t", text_[at_]))
            step();
    }
    void step() {
        const char c = text_[at_++];
        const bool ends = c == '\n' || (c == '\r' && (at_ >= text_.size() || text_[at_] != '\n'));
        column_ = ends ? 1 : column_ + 1;
        line_ += ends;
    }
    std::string_view text_;
    std::size_t at_ = 0;
    std::uint32_t line_ = 1, column_ = 1;
};

double number(Words& words) {
    std::string_view word = words.next();
    const std::string said(word);
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool tiny =
        problem == std::errc::result_out_of_range && (said.find("e-") != said.npos || said.find("E-") != said.npos);
    if (end != word.data() + word.size() || word.empty() || (problem != std::errc() && !tiny) ||
        !(std::abs(value) <= double(std::numeric_limits<float>::max())))
        words.fail(said.empty() ? "the file ends inside a facet" : "\"" + said + "\" is not a finite number");
    return tiny ? 0 : value;
}

void expect(Words& words, std::string_view wanted) {
    const std::string_view word = words.next();
    if (!same(word, wanted))
        words.fail(word.empty() ? "the file ends where \"" + std::string(wanted) + "\" should stand"
                                : "\"" + std::string(word) + "\" stands where \"" + std::string(wanted) + "\" should");
}

Stl read_ascii(std::string_view text) {
    Words words(text);
    Welder welder;
    Stl result;
    expect(words, "solid");
    words.skip_name();
    for (bool open = true;;) {
        const std::string_view word = words.next();
        if (word.empty()) {
            if (open) result.notes.emplace_back("the file ends without \"endsolid\"");
            welder.finish(result);
            return result;
        }
        if (same(word, "solid") || same(word, "endsolid")) {
            open = same(word, "solid");
            words.skip_name();
        } else if (same(word, "facet")) {
            expect(words, "normal");
            for (int i = 0; i < 3; ++i)
                words.next(); // the triangle itself is more accurate
            expect(words, "outer");
            expect(words, "loop");
            for (int corner = 0; corner < 3; ++corner) {
                expect(words, "vertex");
                const double x = number(words), y = number(words), z = number(words);
                welder.add({x, y, z});
            }
            expect(words, "endloop");
            expect(words, "endfacet");
        } else {
            words.fail("\"" + std::string(word) + "\" stands where \"facet\" or \"endsolid\" should");
        }
    }
}

std::string_view without_mark(std::string_view bytes) { // a byte order mark, written by Windows editors
    return bytes.starts_with("\xef\xbb\xbf") ? bytes.substr(3) : bytes;
}

bool contains(std::string_view text, std::string_view lower) { // in any case
    return std::search(text.begin(), text.end(), lower.begin(), lower.end(),
                       [](char a, char b) { return (a | 32) == b; }) != text.end();
}

} // namespace

bool is_binary_stl(std::string_view bytes) {
    return bytes.size() >= header && bytes.size() - header == std::size_t{facet_count(bytes)} * facet;
}

bool is_ascii_stl(std::string_view bytes) {
    bytes = without_mark(bytes);
    const auto start = bytes.find_first_not_of(" \t\r\n");
    return start != bytes.npos && same(bytes.substr(start, 5), "solid") &&
           (contains(bytes, "facet") || contains(bytes, "endsolid")) && bytes.find('\0') == bytes.npos;
}

Stl read_stl(std::string_view bytes) {
    if (is_binary_stl(bytes) || !is_ascii_stl(bytes)) return read_binary(bytes);
    return read_ascii(without_mark(bytes));
}

} // namespace restage::mesh

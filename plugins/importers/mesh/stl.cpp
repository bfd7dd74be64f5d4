// SPDX-License-Identifier: Apache-2.0
#include "stl.hpp"

#include "common/error.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <unordered_map>

namespace restage::mesh {

using namespace importing;

namespace {

constexpr std::size_t header = 84, facet = 50;

struct PointHash {
    std::size_t operator()(const std::array<float, 3>& p) const {
        std::uint64_t h = 0;
        for (const float x : p) {
            std::uint32_t bits = 0;
            std::memcpy(&bits, &x, 4);
            h = (h ^ bits) * 0x9e3779b97f4a7c15ull, h ^= h >> 29;
        }
        return static_cast<std::size_t>(h);
    }
};

class Welder {
  public:
    void add(std::array<float, 3> p) {
        for (float& x : p)
            x += 0.f; // -0 is 0
        const auto [it, fresh] = known_.try_emplace(p, mesh.vertex_count());
        if (fresh) mesh.positions.insert(mesh.positions.end(), p.begin(), p.end());
        mesh.indices.push_back(it->second);
    }
    MeshBuffer mesh;

  private:
    std::unordered_map<std::array<float, 3>, std::uint32_t, PointHash> known_;
};

std::uint32_t facet_count(std::string_view bytes) { // little-endian, as the machines we run on
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + header - 4, 4);
    return count;
}

MeshBuffer read_binary(std::string_view bytes) {
    if (bytes.size() < header) throw ImportError{"byte " + std::to_string(bytes.size()) + ": the header ends early"};
    const std::size_t count = facet_count(bytes), found = (bytes.size() - header) / facet;
    if (found < count)
        throw ImportError{"byte " + std::to_string(bytes.size()) + ": the file is cut: " + std::to_string(count) +
                          " facets promised, " + std::to_string(found) + " found"};
    Welder welder;
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t corner = 0; corner < 3; ++corner) {
            const std::size_t at = header + i * facet + 12 * (corner + 1); // after the normal
            std::array<float, 3> p{};
            std::memcpy(p.data(), bytes.data() + at, 12);
            if (!std::isfinite(p[0]) || !std::isfinite(p[1]) || !std::isfinite(p[2]))
                throw ImportError{"byte " + std::to_string(at) + ": a vertex is not finite"};
            welder.add(p);
        }
    return std::move(welder.mesh);
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
    void skip_line() {
        while (at_ < text_.size() && text_[at_] != '\n')
            step();
    }
    [[noreturn]] void fail(const std::string& what) const { throw ImportError{what, line, column}; }
    std::uint32_t line = 1, column = 1; // of the last word

  private:
    void step() {
        column_ = text_[at_] == '\n' ? 1 : column_ + 1;
        line_ += text_[at_] == '\n';
        ++at_;
    }
    std::string_view text_;
    std::size_t at_ = 0;
    std::uint32_t line_ = 1, column_ = 1;
};

float number(Words& words) {
    std::string_view word = words.next();
    const std::string said(word);
    if (word.starts_with('+')) word.remove_prefix(1);
    float value = 0;
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool tiny = problem == std::errc::result_out_of_range && said.find("e-") != said.npos;
    if (end != word.data() + word.size() || word.empty() || (problem != std::errc() && !tiny) || !std::isfinite(value))
        words.fail(said.empty() ? "the file ends inside a facet" : "\"" + said + "\" is no finite number");
    return value;
}

bool same(std::string_view word, std::string_view lower) { // whatever the case
    if (word.size() != lower.size()) return false;
    for (std::size_t i = 0; i < word.size(); ++i)
        if ((word[i] | 32) != lower[i]) return false;
    return true;
}

void expect(Words& words, std::string_view wanted) {
    const std::string_view word = words.next();
    if (!same(word, wanted))
        words.fail(word.empty() ? "the file ends where \"" + std::string(wanted) + "\" should stand"
                                : "\"" + std::string(word) + "\" stands where \"" + std::string(wanted) + "\" should");
}

MeshBuffer read_ascii(std::string_view text) {
    Words words(text);
    Welder welder;
    expect(words, "solid");
    words.skip_line(); // its name
    for (bool open = true;;) {
        const std::string_view word = words.next();
        if (word.empty()) {
            if (open) words.fail("the file ends before \"endsolid\"");
            return std::move(welder.mesh);
        }
        if (same(word, "solid") || same(word, "endsolid")) {
            open = same(word, "solid");
            words.skip_line();
        } else if (same(word, "facet")) {
            expect(words, "normal");
            for (int i = 0; i < 3; ++i)
                words.next(); // the triangle itself says it better
            expect(words, "outer");
            expect(words, "loop");
            for (int corner = 0; corner < 3; ++corner) {
                expect(words, "vertex");
                const float x = number(words), y = number(words), z = number(words);
                welder.add({x, y, z});
            }
            expect(words, "endloop");
            expect(words, "endfacet");
        } else {
            words.fail("\"" + std::string(word) + "\" stands where \"facet\" or \"endsolid\" should");
        }
    }
}

} // namespace

bool is_binary_stl(std::string_view bytes) {
    return bytes.size() >= header && bytes.size() - header == std::size_t{facet_count(bytes)} * facet;
}

bool is_ascii_stl(std::string_view bytes) {
    const auto start = bytes.find_first_not_of(" \t\r\n");
    return start != bytes.npos && same(bytes.substr(start, 5), "solid") &&
           (bytes.find("facet") != bytes.npos || bytes.find("FACET") != bytes.npos ||
            bytes.find("endsolid") != bytes.npos) &&
           bytes.find('\0') == bytes.npos;
}

MeshBuffer read_stl(std::string_view bytes) {
    if (is_binary_stl(bytes) || !is_ascii_stl(bytes)) return read_binary(bytes);
    return read_ascii(bytes);
}

} // namespace restage::mesh

// SPDX-License-Identifier: Apache-2.0
#include "text.hpp"

#include <array>
#include <charconv>
#include <cmath>

namespace restage::obj {

namespace {

constexpr std::string_view blanks = " \t\r";

// f(line number, keyword, the rest, column of the rest) for every line that says something; f returns false to stop.
// A backslash at the end of a line joins the next one to it.
template <class F>
void each_line(std::string_view text, F&& f) {
    std::uint32_t number = 0;
    std::string joined;
    for (std::size_t at = 0; at < text.size();) {
        const std::uint32_t first = number + 1;
        std::string_view line;
        joined.clear();
        for (bool more = true; more && at < text.size();) {
            const std::size_t end = std::min(text.find('\n', at), text.size());
            std::string_view part = text.substr(at, end - at);
            at = end + 1;
            ++number;
            while (!part.empty() && part.back() == '\r')
                part.remove_suffix(1);
            more = !part.empty() && part.back() == '\\';
            if (more || !joined.empty()) {
                joined += more ? part.substr(0, part.size() - 1) : part;
                line = joined;
            } else {
                line = part;
            }
        }
        const std::size_t start = line.find_first_not_of(blanks);
        if (start == line.npos || line[start] == '#') continue;
        const std::size_t word_end = std::min(line.find_first_of(blanks, start), line.size());
        const std::size_t rest = std::min(line.find_first_not_of(blanks, word_end), line.size());
        std::string_view value = line.substr(rest);
        while (!value.empty() && blanks.find(value.back()) != blanks.npos)
            value.remove_suffix(1);
        if (!f(first, line.substr(start, word_end - start), value, static_cast<std::uint32_t>(rest + 1))) return;
    }
}

// f(word, column) for each word of a line's rest; f returns false to stop.
template <class F>
void each_word(std::string_view rest, std::uint32_t column, F&& f) {
    for (std::size_t at = 0; (at = rest.find_first_not_of(blanks, at)) != rest.npos;) {
        const std::size_t end = std::min(rest.find_first_of(blanks, at), rest.size());
        if (!f(rest.substr(at, end - at), column + static_cast<std::uint32_t>(at))) return;
        at = end;
    }
}

bool known(std::string_view word) {
    for (const std::string_view k : {"v", "vt", "vn", "f", "o", "g", "usemtl", "mtllib", "s", "vw"})
        if (word == k) return true;
    return false;
}

bool is_number(std::string_view word) {
    if (word.starts_with('+')) word.remove_prefix(1);
    double value = 0;
    const auto [end, problem] = std::from_chars(word.data(), word.data() + word.size(), value);
    const bool tiny = problem == std::errc::result_out_of_range && word.find("e-") != word.npos;
    return end == word.data() + word.size() && (tiny || (problem == std::errc() && std::isfinite(value)));
}

} // namespace

ObjText scan_obj(std::string_view text) {
    ObjText result;
    each_line(text, [&](std::uint32_t line, std::string_view word, std::string_view rest, std::uint32_t) {
        if (word == "o" || word == "g") {
            result.shapes.try_emplace(std::string(rest), line);
        } else if (word == "usemtl") {
            result.materials.try_emplace(std::string(rest), line);
        } else if (word == "mtllib") {
            result.libraries.try_emplace(std::string(rest), line);
        } else if (!known(word)) {
            auto& entry = result.skipped.try_emplace(std::string(word), line, 0).first->second;
            ++entry.second;
        }
        return true;
    });
    return result;
}

std::map<std::string, MtlEntry> scan_mtl(std::string_view text) {
    std::map<std::string, MtlEntry> result;
    MtlEntry* current = nullptr;
    each_line(text, [&](std::uint32_t line, std::string_view word, std::string_view rest, std::uint32_t) {
        if (word == "newmtl") {
            current = &result[std::string(rest)];
            *current = {line, {}};
        } else if (current) {
            current->keys.try_emplace(std::string(word), line);
        }
        return true;
    });
    return result;
}

std::optional<Place> find_bad_number(std::string_view text, Find wanted) {
    std::optional<Place> bad;
    long counts[3] = {0, 0, 0}; // v, vt, vn so far; negative indices count from here
    const auto total = [&] {
        long all[3] = {0, 0, 0};
        each_line(text, [&](std::uint32_t, std::string_view word, std::string_view, std::uint32_t) {
            all[0] += word == "v", all[1] += word == "vt", all[2] += word == "vn";
            return true;
        });
        return std::to_array(all);
    }();
    each_line(text, [&](std::uint32_t line, std::string_view word, std::string_view rest, std::uint32_t column) {
        counts[0] += word == "v", counts[1] += word == "vt", counts[2] += word == "vn";
        if (word == "v" && wanted == Find::vertex) {
            int read = 0;
            each_word(rest, column, [&](std::string_view number, std::uint32_t at) {
                if (read < 3 && !is_number(number))
                    bad = Place{line, at, "the coordinate \"" + std::string(number) + "\" is no finite number"};
                return ++read < 3 && !bad;
            });
            if (!bad && read < 3) bad = Place{line, column, "a vertex has three coordinates; this one has fewer"};
        } else if (word == "f") {
            static constexpr const char* kinds[3] = {"vertex", "texture coordinate", "normal"};
            each_word(rest, column, [&](std::string_view corner, std::uint32_t at) {
                std::size_t from = 0;
                for (std::size_t kind = 0; kind < 3 && from <= corner.size() && !bad; ++kind) {
                    const std::size_t end = std::min(corner.find('/', from), corner.size());
                    const std::string_view digits = corner.substr(from, end - from);
                    const auto place = [&](const std::string& what) {
                        bad = Place{line, at + static_cast<std::uint32_t>(from), what};
                    };
                    long index = 0;
                    const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), index);
                    if ((digits.empty() && kind > 0) || (kind == 0) != (wanted == Find::vertex)) {
                        // a corner without it, or not what is looked for
                    } else if (parsed.ec != std::errc() || parsed.ptr != digits.data() + digits.size()) {
                        place("the face names \"" + std::string(digits) + "\", which is no index");
                    } else if (index == 0 || index > total[kind] || -index > counts[kind]) {
                        place("the face names " + std::string(kinds[kind]) + " " + std::to_string(index) + " of " +
                              std::to_string(total[kind]) + (index == 0 ? "; they count from 1" : ""));
                    }
                    from = end + 1;
                }
                return !bad;
            });
        }
        return !bad;
    });
    return bad;
}

} // namespace restage::obj

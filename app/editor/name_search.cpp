// SPDX-License-Identifier: Apache-2.0
#include "name_search.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace restage::editor {

namespace {

constexpr auto lower_case = [] {
    std::array<char, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i)
        table[i] = char(i >= 'A' && i <= 'Z' ? i + ('a' - 'A') : i);
    return table;
}();
char fold(char c) { return lower_case[static_cast<unsigned char>(c)]; }
bool digit(char c) { return c >= '0' && c <= '9'; }
bool upper(char c) { return c >= 'A' && c <= 'Z'; }
// Also the bytes of letters beyond ASCII.
bool letter(char c) { return (fold(c) >= 'a' && fold(c) <= 'z') || (static_cast<unsigned char>(c) & 0x80); }

// "Chair_frame", "chairFrame" and "Chair 2" have two words each.
bool begins_word(std::string_view name, std::size_t i) {
    if (i == 0) return true;
    const char before = name[i - 1], now = name[i];
    if (digit(now)) return !digit(before);
    return letter(now) && (!letter(before) || (upper(now) && !upper(before)));
}

// A bit for each letter and digit in it; all other bytes share one. A name that lacks a bit of the query cannot fit.
std::uint64_t letters_of(std::string_view text) {
    std::uint64_t bits = 0;
    for (const char c : text) {
        const char f = fold(c);
        bits |= std::uint64_t(1) << (f >= 'a' && f <= 'z' ? f - 'a' : digit(f) ? 26 + (f - '0') : 36);
    }
    return bits;
}

bool same(std::string_view name, std::size_t at, std::string_view word) {
    for (std::size_t k = 0; k < word.size(); ++k)
        if (fold(name[at + k]) != fold(word[k])) return false;
    return true;
}

void note(std::vector<std::uint32_t>* at, std::size_t from, std::size_t count) {
    if (at)
        for (std::size_t k = 0; k < count; ++k)
            at->push_back(std::uint32_t(from + k));
}

// In one piece; 0 = not.
int fit_whole(std::string_view name, std::string_view word, std::vector<std::uint32_t>* at) {
    int best = 0;
    std::size_t place = 0;
    for (std::size_t i = 0; i + word.size() <= name.size(); ++i) {
        if (fold(name[i]) != fold(word[0]) || !same(name, i, word)) continue;
        const int now = i == 0 ? (word.size() == name.size() ? best_fit : 900) : begins_word(name, i) ? 800 : 600;
        if (now <= best) continue;
        best = now;
        place = i;
        if (best >= 800) break; // a later one is not better
    }
    if (best > 0) note(at, place, word.size());
    return best;
}

// Its letters in order, each at the next place after the last one's, or at the beginning of a word if the rest still
// fits then.
int fit_apart(std::string_view name, std::string_view word, std::vector<std::uint32_t>* at) {
    constexpr std::size_t most = 32; // longer words only fit in one piece
    if (word.size() > most || word.size() > name.size()) return 0;
    std::array<std::size_t, most> last; // the last place of each letter from which the rest fits
    std::size_t left = word.size();
    for (std::size_t i = name.size(); i > 0 && left > 0; --i)
        if (fold(name[i - 1]) == fold(word[left - 1])) last[--left] = i - 1;
    if (left > 0) return 0;
    std::size_t next = 0, first = 0;
    int starts = 0, joined = 0;
    for (std::size_t k = 0; k < word.size(); ++k) {
        const char wanted = fold(word[k]);
        std::size_t place = name.size();
        if (k > 0 && fold(name[next]) == wanted) {
            place = next;
            ++joined;
        } else {
            for (std::size_t i = next; i <= last[k]; ++i)
                if (fold(name[i]) == wanted) {
                    place = std::min(place, i);
                    if (!begins_word(name, i)) continue;
                    place = i;
                    break;
                }
        }
        starts += begins_word(name, place);
        if (k == 0) first = place;
        note(at, place, 1);
        next = place + 1;
    }
    const int letters = int(word.size());
    const int gaps = int(next - first) - letters;
    return std::max(150 + 250 * starts / letters + 100 * joined / letters - std::min(gaps, 80), 1);
}

int fit_word(std::string_view name, std::string_view word, std::vector<std::uint32_t>* at) {
    const int whole = fit_whole(name, word, at);
    return whole > 0 ? whole : fit_apart(name, word, at);
}

// f(word) for each; false stops.
template <class F>
bool each_word(std::string_view query, F&& f) {
    for (std::size_t i = 0; i < query.size();) {
        if (query[i] == ' ') {
            ++i;
            continue;
        }
        const std::size_t end = std::min(query.find(' ', i), query.size());
        if (!f(query.substr(i, end - i))) return false;
        i = end;
    }
    return true;
}

// Every word fits the name, or begins a word of `more`.
int fit_either(std::string_view name, std::string_view more, std::string_view query) {
    int sum = 0, words = 0;
    const bool all = each_word(query, [&](std::string_view word) {
        const int one = std::max(fit_word(name, word, nullptr), fit_whole(more, word, nullptr) >= 800 ? 100 : 0);
        sum += one;
        ++words;
        return one > 0;
    });
    return all ? sum / words : 0;
}

std::string_view trimmed(std::string_view query) {
    while (!query.empty() && query.front() == ' ')
        query.remove_prefix(1);
    while (!query.empty() && query.back() == ' ')
        query.remove_suffix(1);
    return query;
}

} // namespace

int fit(std::string_view name, std::string_view query, std::vector<std::uint32_t>* at) {
    if (at) at->clear();
    query = trimmed(query);
    if (query.empty()) return best_fit;
    int found = query.size() <= name.size() ? fit_whole(name, query, at) : 0;
    if (found == 0) {
        int sum = 0, words = 0;
        const bool all = each_word(query, [&](std::string_view word) {
            const int one = fit_word(name, word, at);
            sum += one;
            ++words;
            return one > 0;
        });
        found = all ? sum / words : 0;
    }
    if (at) {
        if (found == 0) at->clear();
        std::ranges::sort(*at);
        at->erase(std::unique(at->begin(), at->end()), at->end());
    }
    if (found == 0 || found == best_fit) return found;
    return std::max(found - int(std::min(name.size(), std::size_t(90))), 1);
}

void NameList::clear() {
    text_.clear();
    items_.clear();
}

NameList::Text NameList::keep(std::string_view text) {
    const Text kept{std::uint32_t(text_.size()), std::uint32_t(text.size())};
    text_ += text;
    return kept;
}

void NameList::add(std::string_view name, std::string_view more, int bonus) {
    items_.push_back({.name = keep(name),
                      .more = keep(more),
                      .letters = letters_of(name) | letters_of(more),
                      .bonus = std::clamp(bonus, 0, most_bonus)});
}

std::vector<std::uint32_t> NameList::find(std::string_view query) const {
    query = trimmed(query);
    // Sorted by counting: fits are small numbers, and equal ones stay in order.
    std::array<std::uint32_t, best_fit + most_bonus + 2> below{};
    std::vector<std::uint16_t> fits(items_.size());
    std::uint64_t wanted = 0;
    each_word(query, [&](std::string_view word) { return wanted |= letters_of(word), true; });
    for (std::size_t i = 0; i < items_.size(); ++i) {
        const Item& item = items_[i];
        if ((item.letters & wanted) != wanted) continue;
        int found = fit(text(item.name), query);
        if (found == 0 && item.more.size > 0) found = fit_either(text(item.name), text(item.more), query);
        if (found == 0) continue;
        fits[i] = std::uint16_t(found + item.bonus);
        ++below[std::size_t(fits[i])];
    }
    std::uint32_t count = 0;
    for (std::size_t f = below.size(); f-- > 1;) {
        const std::uint32_t here = below[f];
        below[f] = count;
        count += here;
    }
    std::vector<std::uint32_t> found(count);
    for (std::size_t i = 0; i < items_.size(); ++i)
        if (fits[i] > 0) found[below[fits[i]]++] = std::uint32_t(i);
    return found;
}

} // namespace restage::editor

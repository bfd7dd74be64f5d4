// SPDX-License-Identifier: Apache-2.0
// Search in names while a query is typed: its letters in order, anywhere in a name, ranked by how well they fit. Upper
// and lower case (of ASCII) are the same; a blank separates words, which may be in any order. [any]
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace restage::editor {

// How well a name fits: 0 = not at all, up to best_fit for the name itself. Better are, in this order, its beginning,
// the beginning of a word in it, another part of it, and letters apart from each other; of these, those that begin
// words. Of names that fit alike the shorter is better. `at`: null, or gets the bytes that matched, in ascending order.
inline constexpr int best_fit = 1000;
int fit(std::string_view name, std::string_view query, std::vector<std::uint32_t>* at = nullptr);

// Many names, in one piece of memory.
class NameList {
  public:
    static constexpr int most_bonus = 200;
    void clear();
    // `more`: other text, of which words may begin with one of the query; worth less ("Ctrl+Z"). `bonus`: added to its
    // fit, from 0 to most_bonus; used things have one.
    void add(std::string_view name, std::string_view more = {}, int bonus = 0);
    std::size_t size() const { return items_.size(); }
    std::string_view name(std::size_t i) const { return text(items_[i].name); }

    // The numbers of those that fit, the best first, equal ones in the order of addition; all for an empty query.
    // 100,000 names take some milliseconds.
    std::vector<std::uint32_t> find(std::string_view query) const;

  private:
    struct Text {
        std::uint32_t begin = 0, size = 0;
    };
    struct Item {
        Text name, more;
        std::uint64_t letters = 0; // of both, see letters_of()
        int bonus = 0;
    };
    std::string_view text(Text t) const { return std::string_view(text_).substr(t.begin, t.size); }
    Text keep(std::string_view text);

    std::string text_;
    std::vector<Item> items_;
};

} // namespace restage::editor

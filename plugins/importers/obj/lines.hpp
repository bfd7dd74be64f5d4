// SPDX-License-Identifier: Apache-2.0
// OBJ and MTL as statements: lines, joined where one ends in a backslash, with their places.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace restage::obj {

struct Statement {
    std::uint32_t line = 0, column = 0; // of the first character of `rest`
    std::string_view word, rest; // the keyword, and the rest without surrounding blanks. Valid until the next one
};

// Takes \n, \r\n and \r as ends of a line, and a byte order mark at the beginning of the text.
class Statements {
  public:
    explicit Statements(std::string_view text);
    bool next(Statement&); // skips comments and empty lines
    std::size_t position() const { return at_; } // [byte] after the last statement

  private:
    std::string_view line(); // with at_ after its end
    std::string_view text_;
    std::size_t at_ = 0;
    std::uint32_t number_ = 0;
    std::string joined_;
};

// Words of a statement's rest, from left to right, up to a comment.
class Words {
  public:
    Words(std::string_view rest, std::uint32_t column) : rest_(rest), first_column_(column) {}
    std::optional<std::string_view> next();
    std::optional<std::string_view> peek() const { return Words(*this).next(); }
    std::string_view remainder() const; // the remaining text, without leading blanks
    std::uint32_t column() const { return first_column_ + static_cast<std::uint32_t>(start_); } // of the last word

  private:
    std::string_view rest_;
    std::uint32_t first_column_;
    std::size_t at_ = 0, start_ = 0;
};

// The whole word as a finite number; too small ones are 0.
std::optional<double> number(std::string_view word);

} // namespace restage::obj

// SPDX-License-Identifier: Apache-2.0
// Tokens of pbrt scene files, each with its place, over a stack of included files. Knows no directive.
#pragma once

#include "source.hpp"

#include <deque>

namespace restage::pbrt {

enum class TokenKind {
    end_of_file,
    word,
    text,
    open,
    close
}; // word: a directive, number or true/false; text: "quoted"

struct Token {
    TokenKind kind = TokenKind::end_of_file;
    std::string_view text; // of `text`: without the quotes, escapes resolved
    Location at;
};

class Lexer {
  public:
    explicit Lexer(Sources& sources) : sources_(sources) {}

    // Reads `file` next, then goes on where it was.
    void push(std::uint32_t file);
    void pop() { frames_.pop_back(); }
    std::size_t depth() const { return frames_.size(); }
    // Is `name` being read already, here or further up? (an Include cycle)
    bool is_open(const std::string& name) const;

    // end_of_file is returned again and again until pop().
    Token next();
    const Token& peek();
    // If the next token is a number, takes it: the fast way through long arrays. Throws on "1.2.3", NaN and overflow.
    bool number(double& value);
    Location here();

  private:
    struct Frame {
        std::uint32_t file = 0;
        const char* at = nullptr;
        const char* end = nullptr;
        const char* line_start = nullptr;
        std::uint32_t line = 1;
    };
    void skip_blanks(Frame& frame);
    Location place(const Frame& frame, const char* at) const;
    Token scan();
    Token scan_text(Frame& frame);

    Sources& sources_;
    std::vector<Frame> frames_;
    std::deque<std::string> unescaped_; // strings whose escapes had to be resolved
    Token peeked_;
    bool has_peeked_ = false;
};

// A number in full, as pbrt reads it ("+1", "1.", ".5", "1e-3"); throws ImportError with the remedy.
double parse_number(std::string_view text, Location at);

} // namespace restage::pbrt

// SPDX-License-Identifier: Apache-2.0
// Tokens of pbrt scene files, each with its place, over a stack of included files. Independent of directives.
// Lines that start with `#restage ` are comments to pbrt and text to this lexer: things that Restage keeps and pbrt
// cannot express.
#pragma once

#include "source.hpp"

#include <deque>
#include <utility>

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
    bool ours = false; // on a line that starts with `#restage `: a comment to pbrt
};

class Lexer {
  public:
    explicit Lexer(Sources& sources) : sources_(sources) {}

    // Reads `file` next, then continues where it was. `included`: its tokens and those that follow are one stream, as
    // in pbrt: a file may end between a shape's parameters. Else its end is a token.
    void push(std::uint32_t file, bool included = false);
    void pop() { frames_.pop_back(); }
    std::size_t depth() const { return frames_.size(); }
    // Whether `name` is already being read, here or further up (an Include cycle).
    bool is_open(const std::string& name) const;

    // end_of_file is returned again and again until pop().
    Token next();
    const Token& peek();
    // If the next token is a number, takes it: the fast way through long arrays. Throws on NaN and overflow.
    bool number(double& value);
    // The number at the start of a word, as read by pbrt (strtof): the rest, as in "0," or "1.2.3", is a typo.
    double number_in(const Token& word);
    std::vector<Slip> take_slips() { return std::move(slips_); }
    Location here();
    // Comments on separate lines, without the '#', since the last call; the next token's included if it was
    // peeked at.
    std::vector<std::string_view> take_comments() { return std::exchange(comments_, {}); }
    void forget_comments() { comments_.clear(); }

  private:
    struct Frame {
        std::uint32_t file = 0;
        const char* at = nullptr;
        const char* end = nullptr;
        const char* line_start = nullptr;
        std::uint32_t line = 1;
        const char* ours_from = nullptr; // after the last `#restage `, until the end of its line
        bool included = false;
    };
    bool leave_included(); // at its end: the enclosing frame continues
    void skip_comment(Frame& frame);
    void skip_blanks(Frame& frame);
    Location place(const Frame& frame, const char* at) const;
    Token scan();
    Token scan_text(Frame& frame);

    Sources& sources_;
    std::vector<Frame> frames_;
    std::vector<std::string_view> comments_;
    std::deque<std::string> unescaped_; // strings whose escapes had to be resolved
    Token peeked_;
    bool has_peeked_ = false;
    std::vector<Slip> slips_;
};

// A complete number, as read by pbrt ("+1", "1.", ".5", "1e-3"); throws ImportError with the remedy.
double parse_number(std::string_view text, Location at);

std::string unescape(std::string_view text); // pbrt's \\n, \\t, \\", ...; other backslashes are unchanged

} // namespace restage::pbrt

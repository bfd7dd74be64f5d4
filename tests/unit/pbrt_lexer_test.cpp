// SPDX-License-Identifier: Apache-2.0
// The pbrt importer's lexer: tokens, numbers and places.
#include "lexer.hpp"

#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>

using namespace restage::pbrt;

namespace {

struct Text {
    Sources sources;
    Lexer lexer{sources};
    explicit Text(const std::string& text) { lexer.push(sources.add("t.pbrt", FileBytes::from_memory(text))); }
};

std::string message_of(const std::string& text, Location& at) {
    Text t(text);
    try {
        double value = 0;
        while (true) {
            if (t.lexer.number(value)) continue;
            if (t.lexer.next().kind == TokenKind::end_of_file) return "";
        }
    } catch (const ImportError& error) {
        at = error.at;
        return error.message;
    }
}

} // namespace

TEST_CASE("pbrt lexer: kinds, comments and places", "[pbrt]") {
    Text t("\xEF\xBB\xBF# head\r\nShape \"sphere\" [ 1 ]#end\n\t\"float radius\"2 # \"not this\"\n");
    const auto expect = [&](TokenKind kind, std::string_view text, unsigned line, unsigned column) {
        const Token token = t.lexer.next();
        CHECK(token.kind == kind);
        CHECK(token.text == text);
        CHECK(token.at.line == line);
        CHECK(token.at.column == column);
    };
    expect(TokenKind::word, "Shape", 2, 1);
    expect(TokenKind::text, "sphere", 2, 7);
    expect(TokenKind::open, "[", 2, 16);
    expect(TokenKind::word, "1", 2, 18);
    expect(TokenKind::close, "]", 2, 20);
    expect(TokenKind::text, "float radius", 3, 2);
    expect(TokenKind::word, "2", 3, 16);
    expect(TokenKind::end_of_file, "", 4, 1);
    expect(TokenKind::end_of_file, "", 4, 1); // again and again
}

TEST_CASE("pbrt lexer: numbers in pbrt's forms", "[pbrt]") {
    Text t("1 -2 +3 .5 -.25 4. 1e3 1E-2 +1.5e+2 1e-400 007");
    const double expected[] = {1, -2, 3, 0.5, -0.25, 4, 1000, 0.01, 150, 0, 7};
    for (const double want : expected) {
        double value = -1;
        REQUIRE(t.lexer.number(value));
        CHECK(value == want);
    }
    double value = 0;
    CHECK_FALSE(t.lexer.number(value));
}

TEST_CASE("pbrt lexer: a number after a peek, brackets without blanks", "[pbrt]") {
    Text t("[1 2]\"x\"");
    CHECK(t.lexer.peek().kind == TokenKind::open);
    double value = 0;
    CHECK_FALSE(t.lexer.number(value)); // peeked, and not a number
    t.lexer.next();
    CHECK(t.lexer.peek().text == "1");
    REQUIRE(t.lexer.number(value));
    CHECK(value == 1);
    REQUIRE(t.lexer.number(value));
    CHECK(value == 2);
    CHECK(t.lexer.next().kind == TokenKind::close);
    CHECK(t.lexer.next().text == "x");
}

TEST_CASE("pbrt lexer: text after a number is skipped and reported", "[pbrt]") {
    Text t("1, 2\n 1.2.3 12abc");
    for (const double want : {1.0, 2.0, 1.2, 12.0}) {
        double value = 0;
        REQUIRE(t.lexer.number(value));
        CHECK(value == want);
    }
    const auto slips = t.lexer.take_slips();
    REQUIRE(slips.size() == 3);
    CHECK(slips[1].at.line == 2);
    CHECK(slips[1].at.column == 2);
    CHECK(slips[1].what == "number '1.2.3'");
}

TEST_CASE("pbrt lexer: an included file ends without a token", "[pbrt]") {
    Text t("1 5");
    double value = 0;
    REQUIRE(t.lexer.number(value));
    t.lexer.push(t.sources.add("inner.pbrt", FileBytes::from_memory("2 [")), true);
    t.lexer.push(t.sources.add("deep.pbrt", FileBytes::from_memory("3 # end")), true);
    for (const double want : {3.0, 2.0}) {
        REQUIRE(t.lexer.number(value));
        CHECK(value == want);
    }
    CHECK(t.lexer.next().kind == TokenKind::open);
    REQUIRE(t.lexer.number(value));
    CHECK(value == 5);
    CHECK(t.lexer.next().kind == TokenKind::end_of_file);
}

TEST_CASE("pbrt lexer: escapes and Windows paths", "[pbrt]") {
    Text t(R"("a\"b\\c\td" "textures\wood.png" "plain")");
    CHECK(t.lexer.next().text == "a\"b\\c\td");
    CHECK(t.lexer.next().text == "textures\\wood.png");
    CHECK(t.lexer.next().text == "plain");
}

TEST_CASE("pbrt lexer: errors have their place", "[pbrt]") {
    using Catch::Matchers::ContainsSubstring;
    Location at;
    CHECK_THAT(message_of("1 2\n 1e999", at), ContainsSubstring("'1e999'"));
    CHECK(at.line == 2);
    CHECK(at.column == 2);
    CHECK_THAT(message_of("1e999", at), ContainsSubstring("too large"));
    CHECK_THAT(message_of("-nan", at), ContainsSubstring("number"));
    CHECK_THAT(message_of("-inf", at), ContainsSubstring("number"));
    CHECK_THAT(message_of("\n  \"open", at), ContainsSubstring("inside this string"));
    CHECK(at.line == 2);
    CHECK(at.column == 3);
    CHECK_THAT(message_of("\"open\n\"", at), ContainsSubstring("not closed on its line"));
    CHECK_THAT(message_of("\"open\\", at), ContainsSubstring("inside this string"));
    CHECK(message_of("1 2 3", at).empty());
}

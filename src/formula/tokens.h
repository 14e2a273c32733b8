// Internal: the tokens of GLSL.
#pragma once

#include <span>
#include <string_view>
#include <vector>

namespace relief {

enum class TokenKind { space, word, number, sign };

struct Token {
    TokenKind kind = TokenKind::space; ///< comments are space
    std::string_view text;
    int line = 1;
    bool isOfDirective = false;

    [[nodiscard]] bool isOpening() const { return text == "(" || text == "[" || text == "{"; }
    [[nodiscard]] bool isClosing() const { return text == ")" || text == "]" || text == "}"; }
};

/// Splits GLSL into tokens, which together are the text. Bytes that belong to no token are signs of one byte.
std::vector<Token> readTokens(std::string_view text);

/// Throws Failure::input for macros, and functions that call each other, that would become more code than compilers
/// handle in seconds, however short their text is. `tokens` are without space; `file` stands for the text in messages.
void checkExpansion(std::span<const Token> tokens, std::string_view file);

/// Throws Failure::input, with the line, for brackets and conditionals that have no other half, and for comments
/// without an end. `tokens` are all of a text. Brackets are not counted where conditionals choose among lines, or
/// macros hold one of two.
void checkPairs(std::span<const Token> tokens, std::string_view file);

} // namespace relief

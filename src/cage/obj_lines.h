// Internal: lines of an OBJ file and their words.
#pragma once

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

namespace relief {

inline bool isSpace(char letter) { return letter == ' ' || letter == '\t' || letter == '\v' || letter == '\f'; }

/// Takes the next line off `text`; lines end with LF, CR LF or CR.
inline std::string_view takeLine(std::string_view& text) {
    const auto isEnd = [](char letter) { return letter == '\n' || letter == '\r'; };
    const auto length = std::size_t(std::find_if(text.begin(), text.end(), isEnd) - text.begin());
    const std::string_view line = text.substr(0, length);
    text.remove_prefix(length);
    text.remove_prefix(std::min<std::size_t>(text.starts_with("\r\n") ? 2 : 1, text.size()));
    return line;
}

inline std::string_view trimmed(std::string_view text) {
    while (!text.empty() && isSpace(text.front())) text.remove_prefix(1);
    while (!text.empty() && isSpace(text.back())) text.remove_suffix(1);
    return text;
}

/// A backslash at the end joins the next line, but not when it ends a comment.
inline bool isContinued(std::string_view line) {
    return line.ends_with('\\') && line.find('#') == std::string_view::npos;
}

inline std::string_view firstWord(std::string_view text) {
    return text.substr(0, std::size_t(std::find_if(text.begin(), text.end(), isSpace) - text.begin()));
}

template <typename Number>
std::optional<Number> parseNumber(std::string_view word) {
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    Number value{};
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
    return value;
}

} // namespace relief

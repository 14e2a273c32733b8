// Values over time as text: "90*sin(t)". Read once, computed for every pose.
#pragma once

#include <optional>

#include "base/base.h"

namespace relief {

/// A text that is read from left to right; blanks between words mean nothing.
class TextReader {
public:
    /// Throws Failure::usage for a text of more than 4096 letters. `text` outlives the reader.
    explicit TextReader(std::string_view text);

    [[nodiscard]] bool isAtEnd();
    /// The column where the next word starts, counted from 1.
    [[nodiscard]] std::size_t column();
    /// Takes the next letter if it is this one; returns whether it was.
    bool take(char letter);
    /// Takes a word of letters, digits and underscores that starts with a letter; empty when there is none.
    std::string_view takeWord();
    std::optional<double> takeNumber();
    /// What was taken since a column, without blanks at its ends.
    [[nodiscard]] std::string_view takenSince(std::size_t column) const;

    /// Throws Failure::usage with what was found here and what was expected.
    [[noreturn]] void failExpecting(const std::string& expected);
    /// Throws Failure::usage for a word that is none of `known`, which are `what`.
    [[noreturn]] void failUnknown(std::string_view word, const std::string& what,
                                  const std::vector<std::string>& known);

private:
    void skipBlanks();

    std::string_view text_;
    std::size_t next_ = 0;
};

/// Throws Failure::usage with a message about the given column of the deformers.
template <typename... Args>
[[noreturn]] void failAtColumn(std::size_t column, fmt::format_string<Args...> format, Args&&... args) {
    fail(Failure::usage, "deformers: column {}: {}", column, fmt::format(format, std::forward<Args>(args)...));
}

enum class Step { number, time, negate, add, subtract, multiply, divide, power, sin, cos, abs, min, max };

/// Steps on a stack of numbers, operands first (reverse Polish notation).
struct Arithmetic {
    std::vector<Step> steps;
    std::vector<double> numbers; ///< of the steps `number`, in their order

    [[nodiscard]] bool usesTime() const;
    /// `t` in seconds. Not finite where the arithmetic has no value.
    [[nodiscard]] double at(double t) const;
};

/// Reads arithmetic. From loosely to tightly bound: + and -; * and /; a sign; ^, which groups from the right (-2^2 is
/// -4, 2^3^2 is 2^9); then numbers, t, pi, sin(x), cos(x), abs(x), min(x, y), max(x, y) and parentheses. Stops at the
/// first word that cannot go on. Throws Failure::usage with the column.
Arithmetic readArithmetic(TextReader& text);

} // namespace relief

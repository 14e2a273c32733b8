// Checks of what must hold if the program itself is right: they print both operands. Bad input is answered by fail().
#pragma once

#include <string>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

namespace relief::checks {

/// What a comparison found: empty where it holds, else both operands.
struct Outcome {
    bool holds = true;
    std::string operands;
};

template <typename T>
std::string printed(const T& value) {
    if constexpr (std::is_enum_v<T>)
        return fmt::format("{}", std::underlying_type_t<T>(value));
    else if constexpr (fmt::is_formattable<T>::value)
        return fmt::format("{}", value);
    else
        return "?";
}

/// The left operand of a comparison; integers of different signs are compared by their values.
template <typename Left>
struct Operand {
    const Left& left;

    template <typename Right>
    static constexpr bool kAreIntegers = std::is_integral_v<Left>&& std::is_integral_v<Right> &&
                                         !std::is_same_v<Left, bool> && !std::is_same_v<Right, bool>;

    template <typename Right>
    Outcome outcome(bool holds, const char* sign, const Right& right) const {
        return {holds, holds ? std::string() : fmt::format("{} {} {}", printed(left), sign, printed(right))};
    }

#define RELIEF_COMPARISON(sign, ofIntegers)                                                                            \
    template <typename Right>                                                                                          \
    Outcome operator sign(const Right& right) const {                                                                  \
        if constexpr (kAreIntegers<Right>)                                                                             \
            return outcome(ofIntegers(left, right), #sign, right);                                                     \
        else                                                                                                           \
            return outcome(left sign right, #sign, right);                                                             \
    }
    RELIEF_COMPARISON(==, std::cmp_equal)
    RELIEF_COMPARISON(!=, std::cmp_not_equal)
    RELIEF_COMPARISON(<, std::cmp_less)
    RELIEF_COMPARISON(<=, std::cmp_less_equal)
    RELIEF_COMPARISON(>, std::cmp_greater)
    RELIEF_COMPARISON(>=, std::cmp_greater_equal)
#undef RELIEF_COMPARISON

    // NOLINTNEXTLINE(google-explicit-constructor): a condition without a comparison
    operator Outcome() const { return {bool(left), "false"}; }
};

struct Decomposer {
    template <typename Left>
    Operand<Left> operator<=(const Left& left) const {
        return {left};
    }
};

/// Throws Failure::internal: `file:line: CONDITION does not hold: 3 == 4`.
[[noreturn]] void failCheck(const char* file, int line, const char* condition, const std::string& operands);

} // namespace relief::checks

/// RELIEF_CHECK(a == b), with any comparison or a condition alone; evaluated in all builds, each operand once.
#define RELIEF_CHECK(...)                                                                                              \
    do {                                                                                                               \
        _Pragma("GCC diagnostic push") _Pragma("GCC diagnostic ignored \"-Wparentheses\"")                             \
            const ::relief::checks::Outcome reliefOutcome = ::relief::checks::Decomposer() <= __VA_ARGS__;             \
        _Pragma("GCC diagnostic pop") if (!reliefOutcome.holds)::relief::checks::failCheck(                            \
            __FILE__, __LINE__, #__VA_ARGS__, reliefOutcome.operands);                                                 \
    } while (false)

// Errors with their exit code, and warnings: one line each that a person can act on.
#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace relief {

/// Why something failed; the value is the exit code of the command line.
enum class Failure { internal = 1, usage = 2, input = 3, file = 4, device = 5, check = 6 };

/// One line a person can act on: what, file and line or index, the valid range, what to do.
class Error : public std::runtime_error {
public:
    Error(Failure failure, const std::string& line) : std::runtime_error(line), failure(failure) {}
    Failure failure;
};

/// Throws an Error with the formatted line.
template <typename... Args>
[[noreturn]] void fail(Failure failure, fmt::format_string<Args...> format, Args&&... args) {
    throw Error(failure, fmt::format(format, std::forward<Args>(args)...));
}

/// Called with one line for each thing that is odd but not wrong (an 8-bit height map, a cage without UVs).
using Warn = std::function<void(const std::string&)>;

/// Replaces each control character of `text` by a space, so that file names in messages cannot break the line.
std::string onOneLine(std::string text);

/// Prints to stderr; errors of writing (closed, or a file on a full disk) are ignored.
void printOnStderr(std::string_view text);

/// Prints "warning: LINE" to stderr.
void warnOnStderr(const std::string& line);

} // namespace relief

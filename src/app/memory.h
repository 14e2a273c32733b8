// Memory and threads that run out, here or in the libraries: exit code 5 with one line.
#pragma once

#include <array>
#include <cstddef>
#include <new>

namespace relief::app {

/// What this program's operator new throws. It takes no memory itself.
class OutOfMemory : public std::bad_alloc {
public:
    explicit OutOfMemory(std::size_t bytes) noexcept;
    [[nodiscard]] const char* what() const noexcept override { return text_.data(); }

private:
    std::array<char, 160> text_{};
};

/// Where memory is limited (ulimit -v), a library that crashes or aborts for lack of it ends the program with exit code
/// 5 from now on: drivers do not look at each result. Any other crash stays one.
void endWhereMemoryRunsOut();

} // namespace relief::app

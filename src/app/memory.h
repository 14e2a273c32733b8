// Running out of memory or threads, here or in the libraries, ends the program with exit code 5 and one line.
#pragma once

#include <array>
#include <cstddef>
#include <new>

namespace relief::app {

/// Thrown by this program's operator new. It allocates nothing itself.
class OutOfMemory : public std::bad_alloc {
public:
    explicit OutOfMemory(std::size_t bytes) noexcept;
    [[nodiscard]] const char* what() const noexcept override { return text_.data(); }

private:
    std::array<char, 160> text_{};
};

/// From now on, where memory is limited (ulimit -v), a library that crashes or aborts because there is none left ends
/// the program with exit code 5: drivers do not check every allocation. Any other crash stays a crash.
void endWhereMemoryRunsOut();

} // namespace relief::app

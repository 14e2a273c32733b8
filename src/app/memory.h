// Memory that runs out: how much was asked for.
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

} // namespace relief::app

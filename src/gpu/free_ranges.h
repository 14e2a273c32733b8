// Internal: which bytes of a block of memory are free.
#pragma once

#include <cstdint>
#include <map>
#include <optional>

namespace relief {

/// The free ranges of `size` bytes, at first one range of all of them. Neighbouring free ranges are always one.
class FreeRanges {
public:
    explicit FreeRanges(std::uint64_t size);

    /// Takes `bytes` (at least 1) that start at a multiple of `alignment`, from the smallest free range that holds
    /// them; returns their start, or nothing where no range does.
    std::optional<std::uint64_t> take(std::uint64_t bytes, std::uint64_t alignment);

    /// Gives back bytes exactly as they were taken.
    void giveBack(std::uint64_t start, std::uint64_t bytes);

    [[nodiscard]] std::uint64_t size() const { return size_; }
    [[nodiscard]] std::uint64_t freeBytes() const { return freeBytes_; }
    [[nodiscard]] bool isUnused() const { return freeBytes_ == size_; }
    [[nodiscard]] std::size_t rangeCount() const { return ends_.size(); }

private:
    std::map<std::uint64_t, std::uint64_t> ends_; ///< by start
    std::uint64_t size_, freeBytes_;
};

} // namespace relief

#include "gpu/free_ranges.h"

#include <iterator>

#include "base/base.h"

namespace relief {

FreeRanges::FreeRanges(std::uint64_t size) : ends_{{0, size}}, size_(size), freeBytes_(size) { RELIEF_CHECK(size > 0); }

std::optional<std::uint64_t> FreeRanges::take(std::uint64_t bytes, std::uint64_t alignment) {
    RELIEF_CHECK(bytes > 0);
    RELIEF_CHECK(alignment > 0);
    const auto aligned = [&](std::uint64_t start) { return (start + alignment - 1) / alignment * alignment; };
    auto best = ends_.end();
    for (auto range = ends_.begin(); range != ends_.end(); ++range) {
        const auto [start, end] = *range;
        const bool holds = aligned(start) <= end && end - aligned(start) >= bytes;
        if (holds && (best == ends_.end() || end - start < best->second - best->first)) best = range;
    }
    if (best == ends_.end()) return std::nullopt;

    // What remains before and after stays free.
    const auto [start, end] = *best;
    const std::uint64_t taken = aligned(start);
    ends_.erase(best);
    if (taken > start) ends_[start] = taken;
    if (end > taken + bytes) ends_[taken + bytes] = end;
    freeBytes_ -= bytes;
    return taken;
}

void FreeRanges::giveBack(std::uint64_t start, std::uint64_t bytes) {
    RELIEF_CHECK(bytes > 0);
    RELIEF_CHECK(start + bytes <= size_);
    std::uint64_t end = start + bytes;
    freeBytes_ += bytes;

    auto next = ends_.lower_bound(start);
    if (next != ends_.end()) RELIEF_CHECK(end <= next->first); // else it is free already
    if (next != ends_.begin()) {
        const auto before = std::prev(next);
        RELIEF_CHECK(before->second <= start);
        if (before->second == start) {
            start = before->first;
            ends_.erase(before);
        }
    }
    if (next != ends_.end() && next->first == end) {
        end = next->second;
        ends_.erase(next);
    }
    ends_[start] = end;
}

} // namespace relief

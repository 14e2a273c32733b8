// The free ranges of a block, without a device.
#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "gpu/free_ranges.h"

namespace relief::test {
namespace {

TEST(FreeRanges, aNewBlockIsOneFreeRange) {
    const FreeRanges ranges(100);
    EXPECT_EQ(ranges.freeBytes(), 100u);
    EXPECT_EQ(ranges.rangeCount(), 1u);
    EXPECT_TRUE(ranges.isUnused());
}

TEST(FreeRanges, takeTheWholeBlockAndNoMore) {
    FreeRanges ranges(100);
    EXPECT_EQ(ranges.take(101, 1), std::nullopt);
    EXPECT_EQ(ranges.take(100, 64), 0u);
    EXPECT_EQ(ranges.freeBytes(), 0u);
    EXPECT_EQ(ranges.take(1, 1), std::nullopt);
    ranges.giveBack(0, 100);
    EXPECT_TRUE(ranges.isUnused());
}

TEST(FreeRanges, startAtMultiplesOfTheAlignmentAndKeepWhatLiesBefore) {
    FreeRanges ranges(1000);
    EXPECT_EQ(ranges.take(10, 1), 0u);
    EXPECT_EQ(ranges.take(10, 256), 256u);
    EXPECT_EQ(ranges.freeBytes(), 980u);
    EXPECT_EQ(ranges.take(246, 1), 10u) << "the bytes that the alignment skipped are the smallest range that fits";
    EXPECT_EQ(ranges.take(735, 1), std::nullopt);
    EXPECT_EQ(ranges.take(734, 1), 266u);
}

TEST(FreeRanges, doNotTakeWhereOnlyTheAlignmentFails) {
    FreeRanges ranges(300);
    ASSERT_EQ(ranges.take(1, 1), 0u);
    EXPECT_EQ(ranges.take(100, 256), std::nullopt);
    EXPECT_EQ(ranges.take(44, 256), 256u);
}

TEST(FreeRanges, theSmallestThatFitsIsTaken) {
    FreeRanges ranges(100);
    ASSERT_EQ(ranges.take(30, 1), 0u);
    ASSERT_EQ(ranges.take(5, 1), 30u);
    ASSERT_EQ(ranges.take(10, 1), 35u);
    ASSERT_EQ(ranges.take(5, 1), 45u); // 50..100 is free
    ranges.giveBack(0, 30);
    ranges.giveBack(35, 10);
    EXPECT_EQ(ranges.rangeCount(), 3u);
    EXPECT_EQ(ranges.take(8, 1), 35u);
    EXPECT_EQ(ranges.take(20, 1), 0u);
    EXPECT_EQ(ranges.take(40, 1), 50u);
}

TEST(FreeRanges, neighboursBecomeOne) {
    FreeRanges ranges(40);
    for (std::uint64_t i = 0; i < 4; ++i) ASSERT_EQ(ranges.take(10, 1), 10 * i);
    ranges.giveBack(0, 10);
    ranges.giveBack(20, 10);
    EXPECT_EQ(ranges.rangeCount(), 2u);
    ranges.giveBack(10, 10); // closes the gap between both
    EXPECT_EQ(ranges.rangeCount(), 1u);
    ranges.giveBack(30, 10);
    EXPECT_EQ(ranges.rangeCount(), 1u);
    EXPECT_EQ(ranges.take(40, 1), 0u);
}

TEST(FreeRanges, givingBackTwiceIsFound) {
    FreeRanges ranges(100);
    ASSERT_EQ(ranges.take(50, 1), 0u);
    ranges.giveBack(0, 50);
    EXPECT_ANY_THROW(ranges.giveBack(0, 50));
    EXPECT_ANY_THROW(ranges.giveBack(90, 20));
}

/// Random takes and returns beside a map with one entry per byte.
TEST(FreeRanges, randomSequencesNeverOverlapAndLoseNothing) {
    constexpr std::uint64_t size = 1024;
    for (unsigned seed = 1; seed <= 50; ++seed) {
        std::mt19937 random(seed);
        FreeRanges ranges(size);
        std::vector<bool> isTaken(size);
        std::vector<std::pair<std::uint64_t, std::uint64_t>> taken;
        for (int step = 0; step < 400; ++step) {
            if (random() % 5 < 3 || taken.empty()) {
                const std::uint64_t bytes = 1 + random() % (random() % 4 == 0 ? 300 : 40);
                const std::uint64_t alignment = 1ull << random() % 7;
                const auto start = ranges.take(bytes, alignment);
                if (!start) { // then no aligned gap is long enough
                    for (std::uint64_t at = 0; at + bytes <= size; at += alignment) {
                        const auto first = isTaken.begin() + std::ptrdiff_t(at);
                        ASSERT_TRUE(std::count(first, first + std::ptrdiff_t(bytes), true) > 0) << seed << ' ' << step;
                    }
                    continue;
                }
                ASSERT_EQ(*start % alignment, 0u);
                ASSERT_LE(*start + bytes, size);
                for (std::uint64_t i = *start; i < *start + bytes; ++i) {
                    ASSERT_FALSE(isTaken[i]) << seed << ' ' << step;
                    isTaken[i] = true;
                }
                taken.emplace_back(*start, bytes);
            } else {
                std::swap(taken[random() % taken.size()], taken.back());
                const auto [start, bytes] = taken.back();
                taken.pop_back();
                ranges.giveBack(start, bytes);
                for (std::uint64_t i = start; i < start + bytes; ++i) isTaken[i] = false;
            }
            // One free range per run of free bytes.
            std::size_t gaps = 0;
            for (std::uint64_t i = 0; i < size; ++i) gaps += !isTaken[i] && (i == 0 || isTaken[i - 1]);
            ASSERT_EQ(ranges.rangeCount(), gaps) << seed << ' ' << step;
            ASSERT_EQ(ranges.freeBytes(), std::uint64_t(std::count(isTaken.begin(), isTaken.end(), false)));
        }
        for (const auto& [start, bytes] : taken) ranges.giveBack(start, bytes);
        EXPECT_TRUE(ranges.isUnused());
        EXPECT_EQ(ranges.rangeCount(), 1u);
    }
}

} // namespace
} // namespace relief::test

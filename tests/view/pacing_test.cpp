// When pictures are drawn: nothing while nothing changes, few pixels while something moves, all of them at rest.
#include <gtest/gtest.h>

#include "view/pacing.h"

namespace relief::test {
namespace {

/// At rest after a first picture and one more full picture that took so long.
Pacing restingAfter(double seconds) {
    Pacing pacing(0.033);
    pacing.change(0);
    pacing.drew(Quality::full, 9);
    pacing.change(1);
    pacing.drew(Quality::full, seconds);
    return pacing;
}

TEST(Pacing, drawsTheFirstPictureInFull) {
    Pacing pacing;
    pacing.change(0);
    EXPECT_EQ(pacing.next(0), Quality::full);
}

TEST(Pacing, drawsNothingAtRest) {
    const Pacing pacing = restingAfter(0.5);
    EXPECT_TRUE(pacing.isAtRest());
    EXPECT_EQ(pacing.next(1), Quality::none);
    EXPECT_EQ(pacing.next(1e9), Quality::none);
    EXPECT_LT(pacing.secondsOfRest(2), 0);
}

TEST(Pacing, isCoarseWhileSomethingMovesAndFullWithinASecondOfRest) {
    Pacing pacing = restingAfter(0.5);
    pacing.change(10);
    EXPECT_EQ(pacing.next(10), Quality::coarse);
    pacing.drew(Quality::coarse, 0.02);
    EXPECT_EQ(pacing.next(10.01), Quality::none); // shown already
    pacing.change(10.05);
    EXPECT_EQ(pacing.next(10.06), Quality::coarse);
    pacing.drew(Quality::coarse, 0.02);
    const double rest = pacing.secondsOfRest(10.07);
    EXPECT_GT(rest, 0);
    EXPECT_LT(rest, 1);
    EXPECT_EQ(pacing.next(10.07 + rest + 1e-9), Quality::full);
    pacing.drew(Quality::full, 0.5);
    EXPECT_TRUE(pacing.isAtRest());
}

TEST(Pacing, isNeverCoarseOnAQuickDevice) {
    Pacing pacing = restingAfter(0.01);
    pacing.change(10);
    EXPECT_EQ(pacing.next(10), Quality::full);
}

TEST(Pacing, drawsFewerPixelsUntilTheyFitTheBudget) {
    Pacing pacing = restingAfter(0.5);
    const int first = pacing.divisor();
    // A device that needs 0.4 s for all pixels.
    for (int i = 0; i < 20; ++i) {
        pacing.change(10 + i);
        pacing.drew(Quality::coarse, 0.4 / (pacing.divisor() * pacing.divisor()));
    }
    EXPECT_LE(0.4 / (pacing.divisor() * pacing.divisor()), 0.033);
    // And more again on one that is quick.
    for (int i = 0; i < 20; ++i) pacing.drew(Quality::coarse, 0.001);
    EXPECT_LT(pacing.divisor(), first);
    EXPECT_GE(pacing.divisor(), 2);
}

} // namespace
} // namespace relief::test

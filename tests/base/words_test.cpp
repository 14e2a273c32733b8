#include <gtest/gtest.h>

#include "base/base.h"

namespace relief {
namespace {

TEST(NearestWord, findsTypingErrors) {
    const std::vector<std::string> words = {"catmark", "loop", "bilinear"};
    EXPECT_EQ(nearestWord("catmrak", words), "catmark");
    EXPECT_EQ(nearestWord("lop", words), "loop");
    EXPECT_EQ(nearestWord("Bilinaer", words), "bilinear");
    EXPECT_EQ(nearestWord("loop", words), "loop");
}

TEST(NearestWord, findsNothingWhenNothingIsNear) {
    EXPECT_EQ(nearestWord("sphere", {"catmark", "loop", "bilinear"}), "");
    EXPECT_EQ(nearestWord("", {"a", "b"}), "");
    EXPECT_EQ(nearestWord("loop", {}), "");
    EXPECT_EQ(nearestWord("x", {"y"}), "");
}

TEST(NearestWord, swappedLettersAreOneError) { EXPECT_EQ(nearestWord("reach", {"raech", "roaxh"}), "raech"); }

TEST(NearestWord, prefersTheNearest) {
    EXPECT_EQ(nearestWord("--scael", {"--scheme", "--scale", "--size"}), "--scale");
    EXPECT_EQ(nearestWord("height", {"weights", "weight"}), "weight");
}

TEST(HumanBytes, usesDecimalUnits) {
    EXPECT_EQ(humanBytes(0), "0 B");
    EXPECT_EQ(humanBytes(999), "999 B");
    EXPECT_EQ(humanBytes(1000), "1.0 kB");
    EXPECT_EQ(humanBytes(4'200'000), "4.2 MB");
    EXPECT_EQ(humanBytes(1'000'000'000), "1.0 GB");
    EXPECT_EQ(humanBytes(~0ull), "18.4 EB");
}

TEST(HumanBytes, neverPrintsAThousandOfAUnit) {
    EXPECT_EQ(humanBytes(999'949), "999.9 kB");
    EXPECT_EQ(humanBytes(999'950), "1.0 MB");
    EXPECT_EQ(humanBytes(999'999'999), "1.0 GB");
}

TEST(Bounds, areEmptyUntilSomethingIsAdded) {
    Bounds bounds;
    EXPECT_TRUE(bounds.isEmpty());
    EXPECT_EQ(bounds.diagonal(), 0);
    EXPECT_EQ(bounds.longestSide(), 0);
    bounds.add({1, 2, 3});
    EXPECT_FALSE(bounds.isEmpty());
    EXPECT_EQ(bounds.diagonal(), 0);
    bounds.add({4, 6, 3});
    EXPECT_EQ(bounds.diagonal(), 5);
    EXPECT_EQ(bounds.longestSide(), 4);
    EXPECT_EQ(bounds.center(), dvec3(2.5, 4, 3));
}

std::string stderrOf(const std::function<void()>& action) {
    testing::internal::CaptureStderr();
    action();
    return testing::internal::GetCapturedStderr();
}

TEST(Warnings, areOneLineOnStderr) {
    EXPECT_EQ(stderrOf([] { warnOnStderr("8-bit"); }), "warning: 8-bit\n");
}

TEST(Progress, isSilentWhenStderrIsNoTerminal) {
    EXPECT_EQ(stderrOf([] { Progress("work", 2, ShowProgress::automatic).advance(2); }), "");
}

TEST(Progress, isSilentWhenNotWanted) {
    EXPECT_EQ(stderrOf([] { Progress("work", 2, ShowProgress::never).advance(2); }), "");
}

TEST(Progress, redrawsOneLineAndEndsIt) {
    const std::string text = stderrOf([] {
        Progress progress("work", 4, ShowProgress::always);
        progress.advance();
        progress.advance(100); // more than the total
    });
    EXPECT_TRUE(text.starts_with("\rwork    0 % ░░░░"));
    EXPECT_NE(text.find("\rwork   25 % █████░"), std::string::npos);
    EXPECT_TRUE(text.ends_with("█\n"));
    EXPECT_NE(text.find("\rwork  100 % "), std::string::npos);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1);
}

TEST(Progress, drawsEachPercentOnce) {
    const std::string text = stderrOf([] {
        Progress progress("work", 100000, ShowProgress::always);
        for (int i = 0; i < 100000; ++i) progress.advance();
    });
    EXPECT_EQ(std::count(text.begin(), text.end(), '\r'), 101);
}

TEST(Progress, bearsATotalOfZero) {
    EXPECT_TRUE(stderrOf([] { Progress("work", 0, ShowProgress::always).advance(); }).ends_with("\n"));
}

} // namespace
} // namespace relief

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

TEST(LowerExtension, isOfTheFileAlone) {
    EXPECT_EQ(lowerExtension("a.d/B.Tar.GLB"), ".glb");
    EXPECT_EQ(lowerExtension("a.d/b"), "");
    EXPECT_EQ(lowerExtension("a.d/.glb"), "");
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

} // namespace
} // namespace relief

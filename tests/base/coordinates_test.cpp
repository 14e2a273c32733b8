// Where objects get coordinates of their own, and what those keep exactly.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/base.h"

namespace relief::test {
namespace {

/// A box by its centre and the sizes of its sides.
Bounds boxOf(const dvec3& center, const dvec3& sides) {
    return {.lower = center - 0.5 * sides, .upper = center + 0.5 * sides};
}

TEST(Coordinates, ofOrdinaryObjectsAreTheWorlds) {
    for (const double size : {1e-6, 1e-3, 1.0, 20.0, 2e6})
        for (const double away : {0.0, 0.5, 0.99}) {
            const Bounds box = boxOf(dvec3(0, away * size, 0), dvec3(size, 0, 0));
            EXPECT_TRUE(coordinatesFor(box).isIdentity()) << size << ' ' << away;
        }
    EXPECT_TRUE(coordinatesFor({}).isIdentity());
    EXPECT_TRUE(Coordinates().isIdentity());
}

TEST(Coordinates, takeAnOriginNearObjectsThatAreFarAway) {
    for (const double size : {1e-3, 1.0, 3.7, 1e4})
        for (const double away : {1.1, 30.0, 1e7, 1e12}) {
            const dvec3 center = away * size * dvec3(1, -0.01, 3);
            const Coordinates c = coordinatesFor(boxOf(center, size * dvec3(1, 0.5, 0.25)));
            EXPECT_EQ(c.unit, 1);
            EXPECT_LT(glm::length(c.origin - center), 2 * size);
            const double step = std::ldexp(1.0, std::ilogb(size) + 1);
            for (int k = 0; k < 3; ++k) EXPECT_EQ(std::fmod(c.origin[k], step), 0);
        }
}

TEST(Coordinates, takeAPowerOfTwoAsUnitForTheVerySmallAndTheVeryLarge) {
    for (const double size : {1e-90, 1e-38, 1e-15, 9e-7, 3e6, 1e15, 1e38, 1e90}) {
        const Coordinates c = coordinatesFor(boxOf(dvec3(0), dvec3(size)));
        EXPECT_EQ(c.origin, dvec3(0));
        int exponent = 0;
        EXPECT_EQ(std::frexp(c.unit, &exponent), 0.5) << size;
        EXPECT_GE(size / c.unit, 1);
        EXPECT_LT(size / c.unit, 2);
    }
}

TEST(Coordinates, ofOnePointHaveOnlyAUnit) {
    EXPECT_TRUE(coordinatesFor(boxOf(dvec3(5e5, 0, 4e6), dvec3(0))).origin == dvec3(0));
    EXPECT_LT(coordinatesFor(boxOf(dvec3(1e60), dvec3(0))).toLocal(dvec3(1e60)).x, 2);
}

TEST(Coordinates, ofWhatIsOutOfRangeAreTheWorlds) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity(), kNaN = std::nan("");
    for (const double bad : {kInfinity, kNaN, 1e101, 1e300}) {
        Bounds box = boxOf(dvec3(0), dvec3(1));
        box.upper.y = bad;
        EXPECT_TRUE(coordinatesFor(box).isIdentity()) << bad;
    }
    EXPECT_TRUE(coordinatesFor(boxOf(dvec3(0), dvec3(1e-120))).isIdentity());
}

// Floats of an object at 10^7 are whole numbers: none of their bits gets lost on the way there and back.
TEST(Coordinates, keepEveryFloatThere) {
    const Coordinates c = coordinatesFor(boxOf(dvec3(1e7, 3e6, -1e7), dvec3(300)));
    for (const float x : {9999850.0f, 9999999.0f, 1e7f, 10000150.0f}) {
        const dvec3 world(x, 2999850.25, -1e7);
        const vec3 local = c.toLocal(world);
        EXPECT_EQ(c.toWorld(local), world);
    }
}

TEST(Coordinates, identityKeepsEveryBit) {
    const Coordinates c;
    EXPECT_TRUE(std::signbit(c.toWorld(dvec3(-0.0)).x));
    EXPECT_TRUE(std::signbit(c.toLocal(dvec3(-0.0)).x));
    EXPECT_EQ(c.toLocal(dvec3(0.1)).x, 0.1);
}

TEST(Coordinates, moveBoxes) {
    const Coordinates c{.origin = dvec3(100, 0, -8), .unit = 0.5};
    const Bounds world = c.toWorld(boxOf(dvec3(1), dvec3(2)));
    EXPECT_EQ(world.lower, dvec3(100, 0, -8));
    EXPECT_EQ(world.upper, dvec3(101, 1, -7));
    EXPECT_TRUE(c.toWorld(Bounds()).isEmpty());
}

TEST(Coordinates, spacingIsThatOfFloats) {
    EXPECT_EQ(floatSpacing(dvec3(1e7, 0, 0)), 1);
    EXPECT_EQ(floatSpacing(dvec3(0, -5e6, 3)), 0.5);
}

} // namespace
} // namespace relief::test

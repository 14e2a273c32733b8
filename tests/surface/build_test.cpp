// What buildSurface refuses, and that OpenSubdiv itself stays silent.
#include <gtest/gtest.h>

#include "surface/families.h"

namespace relief {
namespace {

Failure failureOf(const Cage& cage, const SurfaceOptions& options) {
    try {
        buildSurface(cage, options);
    } catch (const Error& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        return error.failure;
    }
    ADD_FAILURE() << "was accepted";
    return Failure::internal;
}

TEST(BuildSurface, RefusesWhatLoopCannotTake) {
    EXPECT_EQ(failureOf(prism(4), {Scheme::loop, 3}), Failure::input);
    EXPECT_THROW(ReferenceSurface(prism(4), {Scheme::loop, 3}), Error);
}

TEST(BuildSurface, RefusesAnIsolationOutOfRange) {
    EXPECT_EQ(failureOf(prism(4), {Scheme::catmark, -1}), Failure::usage);
    EXPECT_EQ(failureOf(prism(4), {Scheme::catmark, 11}), Failure::usage);
    EXPECT_NO_THROW(buildSurface(prism(4), {Scheme::catmark, 10}));
}

// Not because it could not be done, but because memory grows with the square.
TEST(BuildSurface, RefusesThousandsOfNeighbours) {
    EXPECT_EQ(failureOf(test::lonePolygon(1001), {}), Failure::input);
    EXPECT_EQ(failureOf(bipyramid(1001), {Scheme::loop, 2}), Failure::input);
    EXPECT_NO_THROW(buildSurface(test::lonePolygon(200), {Scheme::catmark, 2}));
}

TEST(BuildSurface, RefusesACageWithoutFaces) { EXPECT_EQ(failureOf(Cage{}, {}), Failure::input); }

TEST(BuildSurface, TakesDegenerateFacesWithoutAWord) {
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    Cage repeated = makeCage({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 1, 2}, {0, 2, 3, 0, 2}});
    test::addCrease(repeated, 1, 3, 2); // no edge: OpenSubdiv has a warning for it
    const Surface surface = buildSurface(repeated, {Scheme::catmark, 3});
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    for (const dvec3& p : refinePoints(surface, repeated.positions)) EXPECT_TRUE(glm::all(glm::equal(p, p)));
}

TEST(BuildSurface, ReportsItsSize) {
    const Surface coarse = buildSurface(test::torusWithSeams(), {Scheme::catmark, 2});
    const Surface fine = buildSurface(poles(5), {Scheme::catmark, 6});
    EXPECT_GT(coarse.byteCount(), coarse.patches.size() * sizeof(Patch) + coarse.texPoints.size() * sizeof(vec2));
    EXPECT_GT(fine.byteCount(), fine.stencils.weights.size() * 8);
}

TEST(ReferenceSurface, RefusesHolesAndFacesThatDoNotExist) {
    const ReferenceSurface surface(withHoles(prism(4), {2}), {});
    EXPECT_TRUE(surface.isHole(2));
    EXPECT_FALSE(surface.isHole(1));
    EXPECT_THROW((void)surface.limit(2, {0.5, 0.5}), Error);
    EXPECT_THROW((void)surface.limit(6, {0.5, 0.5}), Error);
    EXPECT_THROW((void)surface.limit(-1, {0.5, 0.5}), Error);
}

} // namespace
} // namespace relief

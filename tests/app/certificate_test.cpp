// What a certificate calls broken: each promise in turn, on certificates made by hand.
#include <limits>

#include <gtest/gtest.h>

#include "app/certificate.h"

namespace relief::test {
namespace {

using app::Certificate;
using app::errorHeat;
using app::Promises;

/// One path of an open cage, with everything as promised.
Certificate soundCertificate() {
    Certificate c{.cage = "cage.obj", .device = "a device", .faceCount = 9, .isolation = 6, .diagonal = 2};
    c.paths.push_back({.path = "grid",
                       .triangles = {.triangles = 18,
                                     .expectedTriangles = 18,
                                     .distinctPoints = 16,
                                     .boundarySegments = 12,
                                     .expectedBoundarySegments = 12},
                       .crackPixels = 0});
    c.frames.regular = {.count = 100, .point = {.max = 9e-7}, .tangent = {.max = 9e-6}};
    return c;
}

/// Expects one broken promise that names all `parts`.
void expectBroken(const Certificate& certificate, const std::vector<std::string>& parts) {
    const std::vector<std::string> broken = certificate.brokenPromises();
    ASSERT_EQ(broken.size(), 1u) << fmt::format("{}", fmt::join(broken, "; "));
    for (const std::string& part : parts)
        EXPECT_NE(broken[0].find(part), std::string::npos) << part << " in " << broken[0];
    EXPECT_EQ(toJson(certificate).at("broken_promises").size(), 1u);
}

TEST(Certificate, isSoundWhenAllPromisesAreKept) {
    EXPECT_TRUE(soundCertificate().brokenPromises().empty());
    EXPECT_TRUE(toJson(soundCertificate()).at("paths").at(0).at("watertight"));
}

TEST(Certificate, isBrokenByEachFaultOfTheTriangles) {
    const std::pair<std::uint64_t Watertightness::*, const char*> counts[] = {
        {&Watertightness::openEdges, "open edges"},
        {&Watertightness::tJunctions, "T-junctions"},
        {&Watertightness::notFinite, "not finite"}};
    for (const auto& [count, words] : counts) {
        Certificate c = soundCertificate();
        c.paths[0].triangles.*count = 3;
        expectBroken(c, {"grid: 3 ", words});
        EXPECT_FALSE(toJson(c).at("paths").at(0).at("watertight"));
    }
}

TEST(Certificate, isBrokenByAMissingTriangle) {
    Certificate c = soundCertificate();
    c.paths[0].triangles.triangles = 17;
    expectBroken(c, {"grid: 17 triangles instead of 18"});
    EXPECT_FALSE(toJson(c).at("paths").at(0).at("watertight"));
}

TEST(Certificate, isBrokenByAnotherBoundary) {
    for (const std::uint64_t count : {11u, 13u}) {
        Certificate c = soundCertificate();
        c.paths[0].triangles.boundarySegments = count;
        expectBroken(c, {fmt::format("{} segments", count), "instead of 12"});
    }
}

TEST(Certificate, isBrokenByPixelsThatSeeACrack) {
    Certificate c = soundCertificate();
    c.paths[0].crackPixels = 2;
    expectBroken(c, {"grid: 2 pixels"});
    EXPECT_FALSE(toJson(c).at("paths").at(0).at("watertight"));
    c.paths[0].crackPixels.reset();
    EXPECT_TRUE(c.brokenPromises().empty()) << "cracks cannot be seen on every surface";
}

TEST(Certificate, isBrokenByFramesThatAreOff) {
    for (const double factor : {1.2, std::numeric_limits<double>::infinity()}) {
        Certificate c = soundCertificate();
        c.frames.regular.point = {.max = factor * 1e-6, .worst = {.face = 7, .uv = {0.5f, 0.25f}}};
        expectBroken(c, {"points", "face 7 (0.5, 0.25)"});
        c = soundCertificate();
        c.frames.regular.tangent = {.max = factor * 1e-5, .worst = {.face = 8}};
        expectBroken(c, {"tangents", "face 8"});
    }
}

TEST(Certificate, isBrokenByPointsThatAreDisplacedWrongly) {
    Certificate c = soundCertificate();
    c.frames.regular.countMisplaced = c.frames.regular.countMisturned = 1; // rounding, in one of a hundred
    EXPECT_TRUE(c.brokenPromises().empty());
    c.frames.regular.countMisplaced = 2;
    expectBroken(c, {"2 of 100", "p + h n"});
    c = soundCertificate();
    c.frames.regular.countMisturned = 2;
    expectBroken(c, {"2 of 100", "normals"});
}

// What a heat map shows in orange: nothing of what rounding does, most at the promise itself.
TEST(Certificate, showsErrorsThatComeNearAPromise) {
    const Promises promises;
    EXPECT_EQ(errorHeat({.point = promises.point / 20, .tangent = promises.tangent / 20}), 0);
    EXPECT_NEAR(errorHeat({.point = promises.point / 2}), 0.7, 0.01);
    EXPECT_NEAR(errorHeat({.point = promises.point / 20, .tangent = promises.tangent / 2}), 0.7, 0.01);
    EXPECT_EQ(errorHeat({.tangent = 3 * promises.tangent}), 1);
    EXPECT_EQ(errorHeat({.point = std::numeric_limits<double>::quiet_NaN()}), 1);
}

TEST(Certificate, isNotBrokenByWhatIsNoPromise) {
    Certificate c = soundCertificate();
    c.frames.endCaps = {.count = 9, .point = {.max = 1}, .tangent = {.max = 1}};
    c.curvature = {.count = 100, .lowestFactor = -3, .area = 1, .foldedArea = 1};
    c.seams = SeamReport{.seamEdgeCount = 4, .max = 1};
    EXPECT_TRUE(c.brokenPromises().empty());
}

TEST(Certificate, isBrokenByANormalThatTurnsInACorner) {
    Certificate c = soundCertificate();
    c.corners = {.count = 4, .max = 90, .worst = {.face = 3, .uv = vec2(1, 0)}};
    expectBroken(c, {"normal at face 3 (1, 0)", "90 degrees"});
}

TEST(Certificate, listsAllBrokenPromises) {
    Certificate c = soundCertificate();
    c.paths.push_back(c.paths[0]);
    c.paths[1].path = "dice";
    c.paths[0].triangles.openEdges = c.paths[1].triangles.tJunctions = 1;
    c.frames.regular.point.max = 1;
    EXPECT_EQ(c.brokenPromises().size(), 3u);
}

// Triangles are a quarter as many with each doubling.
TEST(Certificate, hasSegmentsThatMakeTwoMillionTrianglesAtMost) {
    const auto limited = [](double trianglesOfOnePixel) {
        return app::limitEdgePixels(
            2, 1024, [&](double pixels) { return std::uint64_t(trianglesOfOnePixel / (pixels * pixels)); });
    };
    EXPECT_EQ(limited(8e6), 2) << "two million are allowed";
    EXPECT_EQ(limited(8.1e6), 4);
    EXPECT_EQ(limited(8e8), 32);
    EXPECT_EQ(limited(1e15), 1024) << "the picture has no longer ones";
}

TEST(Certificate, saysThatSegmentsWereLimited) {
    Certificate c = soundCertificate();
    EXPECT_FALSE(toJson(c).contains("limited_edge_pixels"));
    c.limitedEdgePixels = 16;
    EXPECT_EQ(toJson(c).at("limited_edge_pixels"), 16);
}

} // namespace
} // namespace relief::test

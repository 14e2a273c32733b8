// What the certificate says of surfaces whose errors are known, and sculpts of any winding.
#include <gtest/gtest.h>

#include "bake/sculpts.h"

namespace relief::test {
namespace {

TriangleMesh flatSculpt(double height) {
    return hillsOverGrid(16, [height](double, double) { return height; });
}

TEST(BakeCertificate, measuresBothWays) {
    const Baking baking(squareGrid(), {.width = 8, .height = 8, .wrap = Wrap::clamp});
    const MeasuredSurface sculpt = measured(flatSculpt(0.25));
    const HeightMap exact = makeHeightMap(1, 1, {0.25f}, 0, 1, Wrap::clamp);
    const HeightMap off = makeHeightMap(1, 1, {0.2f}, 0, 1, Wrap::clamp);
    const BakeCertificateOptions options{.lines = {.reach = {1, 1}}, .triangleCount = 20'000, .wantsDistances = true};
    const BakeCertificate good = certifyBake(baking.reference, exact, sculpt, options);
    EXPECT_LT(good.distance.hausdorff(), 1e-6);
    EXPECT_EQ(good.missedShare, 0);
    const BakeCertificate bad = certifyBake(baking.reference, off, sculpt, options);
    EXPECT_NEAR(bad.distance.forth.rms, 0.05, 1e-6);
    EXPECT_NEAR(bad.distance.back.share95, 0.05, 1e-6);
    for (const float distance : bad.displaced.heights) EXPECT_NEAR(distance, 0.05, 1e-6);
}

TEST(BakeCertificate, findsMissesOnHalfOfTheSurface) {
    const Baking baking(squareGrid());
    TriangleMesh half = flatSculpt(0.25);
    for (vec3& p : half.positions) p.x = p.x / 2 - 0.01f;
    const BakeCertificate certificate =
        certifyBake(baking.reference, makeHeightMap(1, 1, {0.25f}, 0, 1, Wrap::clamp), measured(half),
                    {.lines = {.reach = {1, 1}}, .triangleCount = 20'000});
    EXPECT_NEAR(certificate.missedShare, 0.5, 0.01);
    EXPECT_NEAR(certificate.distance.forth.rms, std::sqrt(2.0 / 3), 0.01);
    EXPECT_LT(certificate.distance.back.rms, 0.01);
}

TEST(BakeCertificate, findsFoldsByCurvatureAndByOrientation) {
    // The tube's radius is 0.75: 0.9 below the surface all of it is turned inside out, 0.4 below nothing is.
    const Cage cage = torusWithSeams(16, 12);
    const Baking baking(cage);
    const MeasuredSurface sculpt = measured(flatSculpt(0));
    const BakeCertificateOptions options{.lines = {.reach = {1, 1}}, .triangleCount = 20'000};
    for (const auto& [height, share] : {std::pair(-0.9f, 1.0), std::pair(-0.4f, 0.0), std::pair(0.4f, 0.0)}) {
        const HeightMap map = makeHeightMap(1, 1, {height}, 0, 1, Wrap::repeat);
        const BakeCertificate certificate = certifyBake(baking.reference, map, sculpt, options);
        EXPECT_NEAR(certificate.foldedShare, share, 1e-9) << height;
        EXPECT_NEAR(certificate.overturnedShare, share, 1e-9) << height;
    }
}

// --- sculpts ------------------------------------------------------------------------------------------------------

TEST(Sculpts, ofAnyWindingGiveTheSameMap) {
    const Baking baking(squareGrid(), {.width = 16, .height = 16, .wrap = Wrap::clamp});
    TriangleMesh mesh = flatSculpt(0.25);
    const LineReach reach{1, 1};
    EXPECT_EQ(findSides(baking.reference, measured(mesh), {.reach = reach}).facing(), Facing::front);
    const BakedHeights expected = baking.bake(measured(mesh), reach);
    turnOver(mesh);
    const SculptSides sides = findSides(baking.reference, measured(mesh), {.reach = reach});
    EXPECT_EQ(sides.facing(), Facing::back);
    EXPECT_EQ(sides.frontCount, 0u);
    EXPECT_EQ(baking.bake(measured(mesh), reach, sides.facing()).heights, expected.heights);
}

TEST(Sculpts, areWoundAlikeByTheMajority) {
    TriangleMesh mesh = flatSculpt(0.25);
    const std::vector<std::uint32_t> before = mesh.indices;
    EXPECT_EQ(windAlike(mesh).turnedCount, 0u);
    turnOver(mesh, 1, 3);
    EXPECT_EQ(windAlike(mesh).turnedCount, (16u * 16 * 2 - 1 + 2) / 3);
    for (std::size_t i = 0; i < before.size(); i += 3) EXPECT_EQ(mesh.indices[i + 1], before[i + 1]) << i / 3;
}

TEST(Sculpts, thatCannotBeWoundAlikeOrAreNotManifoldAreNamed) {
    const TriangleMesh strip = sheetThrough(24, [](double s, double t) {
        const double a = 2 * std::numbers::pi * s, w = t - 0.5, c = std::cos(a / 2), d = std::sin(a / 2);
        // The last column is the first one, upside down, to the bit.
        if (s == 1) return dvec3(1 - w, 0, 0);
        if (s == 0) return dvec3(1 + w, 0, 0);
        return dvec3((1 + w * c) * std::cos(a), w * d, (1 + w * c) * std::sin(a));
    });
    TriangleMesh moebius = strip;
    EXPECT_GT(windAlike(moebius).nonOrientableCount, 0u);
    TriangleMesh fins = flatSculpt(0);
    const auto first = std::uint32_t(fins.positions.size());
    fins.positions.emplace_back(0, 1, 0);
    fins.indices.insert(fins.indices.end(), {fins.indices[1], fins.indices[0], first});
    fins.indices.insert(fins.indices.end(), {first, fins.indices[0], fins.indices[2]});
    const SculptFaults faults = windAlike(fins);
    EXPECT_EQ(faults.nonManifoldCount, 1u);
    EXPECT_EQ(faults.turnedCount, 0u);
}

} // namespace
} // namespace relief::test

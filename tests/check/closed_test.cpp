// Which cages have an inside.
#include <gtest/gtest.h>

#include "check/check.h"
#include "meshes.h"

namespace relief::test {
namespace {

bool encloses(const Cage& cage) { return enclosesVolume(buildSurface(cage, {.isolation = 1})); }

TEST(Volumes, areEnclosedByClosedCages) {
    for (const NamedCage& named : allCages()) {
        const CageSummary s = summarize(named.cage);
        EXPECT_EQ(encloses(named.cage), s.boundaryEdgeCount == 0 && s.holeCount == 0) << named.name;
    }
    EXPECT_TRUE(encloses(nonManifoldEdge())) << "two faces run the common edge one way, two the other";
}

TEST(Volumes, areNotEnclosedWhereFacesTurnTheirBacks) {
    Cage cage = cube();
    std::swap(cage.corners[1], cage.corners[3]);
    EXPECT_FALSE(encloses(cage));
    Cage prism = nGonPrism(5);
    std::reverse(prism.corners.end() - 5, prism.corners.end());
    std::reverse(prism.texCorners.end() - 5, prism.texCorners.end());
    EXPECT_FALSE(encloses(prism));
}

} // namespace
} // namespace relief::test

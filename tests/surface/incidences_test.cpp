// All faces along every edge, against the sides read back by themselves and against the cage's own counts.
#include <algorithm>

#include <gtest/gtest.h>

#include "surface/families.h"
#include "surface/sides.h"

namespace relief {
namespace {

TEST(EdgeIncidenceList, areThePiecesOfAllSides) {
    for (const Family& family : allFamilies()) {
        SCOPED_TRACE(family.name);
        const Surface surface = buildSurface(family.cage, {family.scheme, 1});
        const EdgeIncidences all = edgeIncidences(surface);
        std::size_t count = 0;
        atPieces(surface, [&](const Piece& piece) {
            const auto incidences = all.of(piece.edge);
            EXPECT_EQ(std::ranges::count_if(incidences, [&](const Incidence& t) { return isSame(t, piece.incidence); }),
                      1);
            ++count;
        });
        EXPECT_EQ(all.incidences.size(), count);
        for (std::size_t i = 0; i < surface.edges.size(); ++i) {
            ASSERT_FALSE(all.of(i).empty());
            EXPECT_TRUE(isSame(all.of(i).front(), surface.edges[i].owner)) << "edge " << i;
            EXPECT_TRUE(std::ranges::is_sorted(all.of(i), {}, &Incidence::face));
            const auto listed =
                std::span(surface.incidences).subspan(surface.edges[i].firstIncidence, surface.edges[i].incidenceCount);
            if (!listed.empty()) {
                EXPECT_TRUE(std::ranges::equal(listed, all.of(i), isSame)) << "edge " << i;
            }
        }
    }
}

/// Edges of this surface by how many faces they have: [1], [2], [3 or more].
std::vector<std::uint64_t> edgesByIncidences(const Cage& cage) {
    const Surface surface = buildSurface(cage, {.isolation = 1});
    const EdgeIncidences all = edgeIncidences(surface);
    std::vector<std::uint64_t> counts(4);
    for (std::size_t i = 0; i < surface.edges.size(); ++i) ++counts[std::min<std::size_t>(all.of(i).size(), 3)];
    return counts;
}

TEST(EdgeIncidenceList, areAsManyAsTheCageHas) {
    for (const test::NamedCage& named : test::allCages()) {
        const CageSummary s = summarize(named.cage);
        if (s.quadCount != s.faceCount || s.holeCount > 0) continue;
        const std::vector<std::uint64_t> counts = edgesByIncidences(named.cage);
        EXPECT_EQ(counts[1], s.boundaryEdgeCount) << named.name;
        EXPECT_EQ(counts[1] + counts[2] + counts[3], s.edgeCount) << named.name;
    }
    EXPECT_EQ(edgesByIncidences(test::nonManifoldEdge())[3], 1u);
    EXPECT_EQ(edgesByIncidences(test::moebiusStrip())[1], summarize(test::moebiusStrip()).boundaryEdgeCount);
    EXPECT_EQ(edgesByIncidences(test::lonePolygon(6)), (std::vector<std::uint64_t>{0, 12, 6, 0}));
    EXPECT_EQ(edgesByIncidences(test::torusWithHoles())[1], 10u) << "holes 0 and 1 share an edge, 20 lies alone";
}

} // namespace
} // namespace relief

// Edges, corners and the faces that meet them.
#include <algorithm>
#include <tuple>

#include <gtest/gtest.h>

#include "surface/families.h"
#include "surface/sides.h"

namespace relief {
namespace {

bool isBefore(const Incidence& a, const Incidence& b) {
    return std::tie(a.face, a.side, a.start) < std::tie(b.face, b.side, b.start);
}

template <typename Owned>
std::span<const Incidence> incidencesOf(const Surface& surface, const Owned& owned) {
    return std::span(surface.incidences).subspan(owned.firstIncidence, owned.incidenceCount);
}

/// All faces along each edge, gathered from the faces.
std::vector<std::vector<Incidence>> gatherEdgeIncidences(const Surface& surface) {
    std::vector<std::vector<Incidence>> incidences(surface.edges.size());
    atPieces(surface, [&](const Piece& piece) { incidences.at(piece.edge).push_back(piece.incidence); });
    return incidences;
}

/// All faces around each corner, gathered from the ends of the edges along their sides. (A corner of a face is the
/// start of a side; the middle of a split side is met at its first piece's end.)
std::vector<std::vector<Incidence>> gatherCornerIncidences(const Surface& surface) {
    std::vector<std::vector<Incidence>> incidences(surface.corners.size());
    atPieces(surface, [&](const Piece& piece) {
        const Edge& edge = surface.edges[piece.edge];
        const float start = std::min(piece.incidence.start, piece.incidence.end);
        const bool isReversed = piece.incidence.start > piece.incidence.end;
        incidences.at(edge.corners[isReversed ? 1 : 0])
            .push_back({piece.incidence.face, piece.incidence.side, start, start});
    });
    return incidences;
}

template <typename Check>
void forFamilies(int isolation, const Check& check) {
    for (const Family& family : allFamilies()) {
        SCOPED_TRACE(family.name);
        check(family, buildSurface(family.cage, {family.scheme, isolation}));
    }
}

TEST(Sides, LieOnTheirEdgesPointByPoint) {
    forFamilies(3, [](const Family& family, const Surface& surface) {
        const ReferenceSurface reference(family.cage, {family.scheme, 3});
        double worst = 0;
        atPieces(surface, [&](const Piece& piece) {
            const Incidence& owner = surface.edges.at(piece.edge).owner;
            for (const double t : {0.0, 0.1, 0.25, 0.5, 0.8, 1.0}) {
                const dvec3 own = reference.limit(int(piece.incidence.face), pointOf(surface, piece.incidence, t)).p;
                const dvec3 owners = reference.limit(int(owner.face), pointOf(surface, owner, t)).p;
                worst = std::max(worst, glm::length(own - owners));
            }
        });
        EXPECT_LE(worst, 1e-12 * boundsOf(family.cage).diagonal());
    });
}

TEST(Sides, MeetInTheirFacesCorners) {
    forFamilies(2, [](const Family& family, const Surface& surface) {
        const ReferenceSurface reference(family.cage, {family.scheme, 2});
        for (std::uint32_t face = 0; face < surface.faces.size(); ++face) {
            if (surface.faces[face].root == kNoPatch) continue;
            for (int side = 0; side < surface.sideCount; ++side) {
                const auto last = piecesOf(surface, face, (side + surface.sideCount - 1) % surface.sideCount).back();
                const auto first = piecesOf(surface, face, side).front();
                const auto endOf = [&](const Piece& piece, bool isEnd) {
                    const bool isReversed = piece.incidence.start > piece.incidence.end;
                    return surface.edges[piece.edge].corners[isReversed != isEnd ? 1 : 0];
                };
                const std::uint32_t corner = endOf(first, false);
                EXPECT_EQ(corner, endOf(last, true)) << "face " << face << " corner " << side;
                const Incidence& owner = surface.corners.at(corner).owner;
                const dvec3 owners = reference.limit(int(owner.face), pointOf(surface, owner, 0)).p;
                const dvec3 own = reference.limit(int(face), sidePoint(surface.sideCount, side, 0)).p;
                EXPECT_LE(glm::length(own - owners), 1e-12 * boundsOf(family.cage).diagonal());
            }
        }
    });
}

TEST(Sides, OfHolesHaveNoEdges) {
    const Surface surface = buildSurface(withHoles(prism(4), {2}), {});
    for (const std::uint32_t side : surface.faces[2].sides) EXPECT_EQ(side, kNoPatch);
}

TEST(Edges, AreOwnedByTheLowestFaceWithIncidencesInOrder) {
    forFamilies(2, [](const Family&, const Surface& surface) {
        auto gathered = gatherEdgeIncidences(surface);
        for (std::size_t i = 0; i < surface.edges.size(); ++i) {
            const Edge& edge = surface.edges[i];
            ASSERT_FALSE(gathered[i].empty());
            std::sort(gathered[i].begin(), gathered[i].end(), isBefore);
            EXPECT_TRUE(isSame(edge.owner, gathered[i].front())) << "edge " << i;
            EXPECT_LT(edge.owner.start, edge.owner.end);
            const auto incidences = incidencesOf(surface, edge);
            if (!incidences.empty()) {
                EXPECT_TRUE(
                    std::equal(incidences.begin(), incidences.end(), gathered[i].begin(), gathered[i].end(), isSame))
                    << "edge " << i;
            }
        }
    });
}

TEST(Corners, AreOwnedByTheLowestFaceWithIncidencesInOrder) {
    forFamilies(2, [](const Family&, const Surface& surface) {
        auto gathered = gatherCornerIncidences(surface);
        for (std::size_t i = 0; i < surface.corners.size(); ++i) {
            const Corner& corner = surface.corners[i];
            std::sort(gathered[i].begin(), gathered[i].end(), isBefore);
            ASSERT_FALSE(gathered[i].empty());
            EXPECT_TRUE(isSame(corner.owner, gathered[i].front())) << "corner " << i;
            const auto incidences = incidencesOf(surface, corner);
            if (!incidences.empty()) {
                EXPECT_TRUE(
                    std::equal(incidences.begin(), incidences.end(), gathered[i].begin(), gathered[i].end(), isSame))
                    << "corner " << i;
            }
        }
    });
}

TEST(Edges, OfSplitSidesAreConsecutivePartners) {
    forFamilies(2, [](const Family&, const Surface& surface) {
        for (std::uint32_t i = 0; i < surface.edges.size(); ++i) {
            const Edge& edge = surface.edges[i];
            const Edge& partner = surface.edges.at(edge.partner);
            EXPECT_EQ(partner.partner, i);
            if (edge.partner == i + 1) {
                EXPECT_EQ(edge.corners[1], partner.corners[0]);
            } else if (edge.partner != i) {
                EXPECT_EQ(edge.partner, i - 1);
            }
        }
        atPieces(surface, [&](const Piece& piece) {
            const bool isSplit = surface.faces[piece.incidence.face].sides[piece.incidence.side] & kSideSplit;
            if (isSplit) {
                EXPECT_NE(surface.edges[piece.edge].partner, piece.edge);
            }
        });
    });
}

// Where faces see different normals, they share a direction of displacement: no incidences means one normal.
TEST(Incidences, AreListedWhereverNormalsDisagree) {
    forFamilies(6, [](const Family& family, const Surface& surface) {
        const ReferenceSurface reference(family.cage, {family.scheme, 6});
        const auto normalAt = [&](const Incidence& incidence, double t) {
            return reference.normal(int(incidence.face), pointOf(surface, incidence, t));
        };
        const auto edgeIncidences = gatherEdgeIncidences(surface), cornerIncidences = gatherCornerIncidences(surface);
        for (std::size_t i = 0; i < surface.edges.size(); ++i) {
            if (surface.edges[i].incidenceCount > 0) continue;
            for (const Incidence& incidence : edgeIncidences[i])
                for (const double t : {0.02, 0.3, 0.7})
                    EXPECT_LE(degreesBetween(normalAt(incidence, t), normalAt(edgeIncidences[i][0], t)), 1.0)
                        << "edge " << i;
        }
        for (std::size_t i = 0; i < surface.corners.size(); ++i) {
            if (surface.corners[i].incidenceCount > 0) continue;
            for (const Incidence& incidence : cornerIncidences[i])
                EXPECT_LE(degreesBetween(normalAt(incidence, 0), normalAt(cornerIncidences[i][0], 0)), 1.0)
                    << "corner " << i;
        }
    });
}

struct Counts {
    int edges = 0, corners = 0; ///< with incidences
    bool operator==(const Counts&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Counts& c) { return out << c.edges << " edges, " << c.corners; }

Counts incidenceCounts(const Surface& surface) {
    const auto hasIncidences = [](const auto& owned) { return owned.incidenceCount > 0; };
    return {int(std::count_if(surface.edges.begin(), surface.edges.end(), hasIncidences)),
            int(std::count_if(surface.corners.begin(), surface.corners.end(), hasIncidences))};
}

Counts incidenceCounts(const Cage& cage, int isolation = 3, Scheme scheme = Scheme::catmark) {
    return incidenceCounts(buildSurface(cage, {scheme, isolation}));
}

TEST(Incidences, AreListedOnlyWhereTheSurfaceIsNotSmooth) {
    const std::vector<std::uint32_t> top{4, 5, 6, 7};
    EXPECT_EQ(incidenceCounts(prism(4)), (Counts{0, 0}));
    EXPECT_EQ(incidenceCounts(prism(5)), (Counts{0, 0}));
    EXPECT_EQ(incidenceCounts(icosahedron(), 3, Scheme::loop), (Counts{0, 0}));
    EXPECT_EQ(incidenceCounts(withCreases(prism(4), top, 10)), (Counts{4, 4}));
    EXPECT_EQ(incidenceCounts(withCreases(prism(4), top, 2.5F)), (Counts{0, 0}));
    EXPECT_EQ(incidenceCounts(withCreases(prism(4), top, 2.5F), 2), (Counts{4, 4}));
    EXPECT_EQ(incidenceCounts(withCreases(prism(4), top, 10), 10), (Counts{4, 4}));
    EXPECT_EQ(incidenceCounts(withSharpVertex(prism(4), 2, 10)), (Counts{0, 1}));
    EXPECT_EQ(incidenceCounts(withSharpVertex(prism(4), 2, 10), 10), (Counts{0, 1}));
    EXPECT_EQ(incidenceCounts(withSharpVertex(prism(4), 2, 2)), (Counts{0, 0}));
    EXPECT_EQ(incidenceCounts(withSharpVertex(prism(4), 2, 2), 1), (Counts{0, 1}));
    EXPECT_EQ(incidenceCounts(withCreases(prism(5), {5, 6, 7, 8, 9}, 10)), (Counts{10, 10}));
    EXPECT_EQ(incidenceCounts(sheet(4, 3)), (Counts{14, 14}));
    EXPECT_EQ(incidenceCounts(fins()), (Counts{10, 8}));
    EXPECT_EQ(incidenceCounts(test::nonManifoldEdge()), (Counts{1, 2}));
    EXPECT_EQ(incidenceCounts(twistedPair()), (Counts{7, 6}));
    EXPECT_EQ(incidenceCounts(test::nonManifoldVertex()), (Counts{0, 1}));
    EXPECT_EQ(incidenceCounts(prism(5), 3, Scheme::bilinear), (Counts{35, 22}));
}

// Chaikin's rule averages sharpness along a crease: an edge below the limit beside one above it may stay sharp.
TEST(Incidences, CountChaikinNeighboursAsSharp) {
    Cage cage = withChaikin(withCreases(prism(4), {4, 5, 6, 7}, 2));
    cage.creaseSharpness[0] = 8;
    EXPECT_EQ(incidenceCounts(cage, 3), (Counts{4, 4}));
    cage.creaseSharpness[0] = 3;
    EXPECT_EQ(incidenceCounts(cage, 3), (Counts{0, 0}));
}

TEST(Incidences, NameAllFacesOfANonManifoldEdge) {
    const Surface surface = buildSurface(fins(), {});
    const auto isShared = [](const Edge& edge) { return edge.incidenceCount == 3; };
    EXPECT_EQ(std::count_if(surface.edges.begin(), surface.edges.end(), isShared), 1);
}

TEST(Incidences, NameAllFansOfAVertex) {
    const Surface surface = buildSurface(test::nonManifoldVertex(), {});
    std::vector<std::uint32_t> faces;
    for (const Corner& corner : surface.corners) {
        const auto incidences = incidencesOf(surface, corner);
        const bool isMeeting =
            std::any_of(incidences.begin(), incidences.end(), [](const Incidence& t) { return t.face < 6; }) &&
            std::any_of(incidences.begin(), incidences.end(), [](const Incidence& t) { return t.face >= 6; });
        if (!isMeeting) continue;
        for (const Incidence& incidence : incidences) faces.push_back(incidence.face);
    }
    EXPECT_EQ(faces, (std::vector<std::uint32_t>{1, 3, 5, 6, 8, 10}));
}

TEST(Incidences, OmitHoles) {
    const Surface surface = buildSurface(withHoles(withCreases(prism(4), {4, 5, 6, 7}, 10), {5}), {});
    for (const Incidence& incidence : surface.incidences) EXPECT_NE(incidence.face, 5u);
    for (const Edge& edge : surface.edges) EXPECT_LE(edge.incidenceCount, 1u);
}

// V - E + F; the halves of a split side count as two edges of its face.
int eulerCharacteristic(const Surface& surface) {
    return int(surface.corners.size()) - int(surface.edges.size()) + int(surface.faces.size());
}

TEST(Owners, FormTheTopologyOfTheCage) {
    for (const int n : {3, 4, 5, 9}) {
        EXPECT_EQ(eulerCharacteristic(buildSurface(prism(n), {})), 2);
        EXPECT_EQ(eulerCharacteristic(buildSurface(poles(n), {})), 2);
        EXPECT_EQ(eulerCharacteristic(buildSurface(bipyramid(n), {Scheme::loop, 3})), 2);
    }
    EXPECT_EQ(eulerCharacteristic(buildSurface(test::torusWithSeams(), {})), 0);
    EXPECT_EQ(eulerCharacteristic(buildSurface(sheet(4, 3), {})), 1);
    EXPECT_EQ(eulerCharacteristic(buildSurface(pentagons(), {})), 1);
}

TEST(Owners, FindWhetherTheSurfaceIsClosed) {
    EXPECT_TRUE(buildSurface(prism(5), {}).isClosed);
    EXPECT_TRUE(buildSurface(test::torusWithSeams(), {}).isClosed);
    EXPECT_TRUE(buildSurface(icosahedron(), {Scheme::loop, 3}).isClosed);
    EXPECT_FALSE(buildSurface(sheet(2, 2), {}).isClosed);
    EXPECT_FALSE(buildSurface(withHoles(prism(5), {0}), {}).isClosed);
}

TEST(SidePoints, RunFromCornerToCorner) {
    for (const int sideCount : {3, 4}) {
        for (int side = 0; side < sideCount; ++side)
            EXPECT_EQ(sidePoint(sideCount, side, 1), sidePoint(sideCount, (side + 1) % sideCount, 0));
        EXPECT_EQ(sidePoint(sideCount, 0, 0), dvec2(0, 0));
        EXPECT_EQ(sidePoint(sideCount, 1, 0), dvec2(1, 0));
        EXPECT_EQ(sidePoint(sideCount, 0, 0.25), dvec2(0.25, 0));
    }
    EXPECT_EQ(sidePoint(4, 2, 0.25), dvec2(0.75, 1));
    EXPECT_EQ(sidePoint(3, 1, 0.25), dvec2(0.75, 0.25));
}

} // namespace
} // namespace relief

// Edges, corners and the faces that touch them.
#include <algorithm>
#include <tuple>

#include <gtest/gtest.h>

#include "surface/families.h"
#include "surface/sides.h"

namespace relief {
namespace {

bool isBefore(const Touch& a, const Touch& b) {
    return std::tie(a.face, a.side, a.start) < std::tie(b.face, b.side, b.start);
}

template <typename Owned>
std::span<const Touch> touchesOf(const Surface& surface, const Owned& owned) {
    return std::span(surface.touches).subspan(owned.firstTouch, owned.touchCount);
}

/// All faces along each edge, gathered from the faces.
std::vector<std::vector<Touch>> gatherEdgeTouches(const Surface& surface) {
    std::vector<std::vector<Touch>> touches(surface.edges.size());
    atPieces(surface, [&](const Piece& piece) { touches.at(piece.edge).push_back(piece.touch); });
    return touches;
}

/// All faces around each corner, gathered from the ends of the edges along their sides. (A corner of a face is the
/// start of a side; the middle of a split side is met at its first piece's end.)
std::vector<std::vector<Touch>> gatherCornerTouches(const Surface& surface) {
    std::vector<std::vector<Touch>> touches(surface.corners.size());
    atPieces(surface, [&](const Piece& piece) {
        const Edge& edge = surface.edges[piece.edge];
        const float start = std::min(piece.touch.start, piece.touch.end);
        const bool isReversed = piece.touch.start > piece.touch.end;
        touches.at(edge.corners[isReversed ? 1 : 0]).push_back({piece.touch.face, piece.touch.side, start, start});
    });
    return touches;
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
            const Touch& owner = surface.edges.at(piece.edge).owner;
            for (const double t : {0.0, 0.1, 0.25, 0.5, 0.8, 1.0}) {
                const dvec3 own = reference.limit(int(piece.touch.face), pointOf(surface, piece.touch, t)).p;
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
                    const bool isReversed = piece.touch.start > piece.touch.end;
                    return surface.edges[piece.edge].corners[isReversed != isEnd ? 1 : 0];
                };
                const std::uint32_t corner = endOf(first, false);
                EXPECT_EQ(corner, endOf(last, true)) << "face " << face << " corner " << side;
                const Touch& owner = surface.corners.at(corner).owner;
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

TEST(Edges, AreOwnedByTheLowestFaceAndTouchedInOrder) {
    forFamilies(2, [](const Family&, const Surface& surface) {
        auto gathered = gatherEdgeTouches(surface);
        for (std::size_t i = 0; i < surface.edges.size(); ++i) {
            const Edge& edge = surface.edges[i];
            ASSERT_FALSE(gathered[i].empty());
            std::sort(gathered[i].begin(), gathered[i].end(), isBefore);
            EXPECT_TRUE(isSame(edge.owner, gathered[i].front())) << "edge " << i;
            EXPECT_LT(edge.owner.start, edge.owner.end);
            const auto touches = touchesOf(surface, edge);
            if (!touches.empty()) {
                EXPECT_TRUE(std::equal(touches.begin(), touches.end(), gathered[i].begin(), gathered[i].end(), isSame))
                    << "edge " << i;
            }
        }
    });
}

TEST(Corners, AreOwnedByTheLowestFaceAndTouchedInOrder) {
    forFamilies(2, [](const Family&, const Surface& surface) {
        auto gathered = gatherCornerTouches(surface);
        for (std::size_t i = 0; i < surface.corners.size(); ++i) {
            const Corner& corner = surface.corners[i];
            std::sort(gathered[i].begin(), gathered[i].end(), isBefore);
            ASSERT_FALSE(gathered[i].empty());
            EXPECT_TRUE(isSame(corner.owner, gathered[i].front())) << "corner " << i;
            const auto touches = touchesOf(surface, corner);
            if (!touches.empty()) {
                EXPECT_TRUE(std::equal(touches.begin(), touches.end(), gathered[i].begin(), gathered[i].end(), isSame))
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
            const bool isSplit = surface.faces[piece.touch.face].sides[piece.touch.side] & kSideSplit;
            if (isSplit) {
                EXPECT_NE(surface.edges[piece.edge].partner, piece.edge);
            }
        });
    });
}

// Where faces see different normals, the direction of displacement must be agreed: no touches means one normal.
TEST(Touches, AreListedWhereverNormalsDisagree) {
    forFamilies(6, [](const Family& family, const Surface& surface) {
        const ReferenceSurface reference(family.cage, {family.scheme, 6});
        const auto normalAt = [&](const Touch& touch, double t) {
            return reference.normal(int(touch.face), pointOf(surface, touch, t));
        };
        const auto edgeTouches = gatherEdgeTouches(surface), cornerTouches = gatherCornerTouches(surface);
        for (std::size_t i = 0; i < surface.edges.size(); ++i) {
            if (surface.edges[i].touchCount > 0) continue;
            for (const Touch& touch : edgeTouches[i])
                for (const double t : {0.02, 0.3, 0.7})
                    EXPECT_LE(degreesBetween(normalAt(touch, t), normalAt(edgeTouches[i][0], t)), 1.0) << "edge " << i;
        }
        for (std::size_t i = 0; i < surface.corners.size(); ++i) {
            if (surface.corners[i].touchCount > 0) continue;
            for (const Touch& touch : cornerTouches[i])
                EXPECT_LE(degreesBetween(normalAt(touch, 0), normalAt(cornerTouches[i][0], 0)), 1.0) << "corner " << i;
        }
    });
}

struct Counts {
    int edges = 0, corners = 0; ///< with touches
    bool operator==(const Counts&) const = default;
};
std::ostream& operator<<(std::ostream& out, const Counts& c) { return out << c.edges << " edges, " << c.corners; }

Counts touched(const Surface& surface) {
    const auto isTouched = [](const auto& owned) { return owned.touchCount > 0; };
    return {int(std::count_if(surface.edges.begin(), surface.edges.end(), isTouched)),
            int(std::count_if(surface.corners.begin(), surface.corners.end(), isTouched))};
}

Counts touched(const Cage& cage, int isolation = 3, Scheme scheme = Scheme::catmark) {
    return touched(buildSurface(cage, {scheme, isolation}));
}

TEST(Touches, AreListedOnlyWhereTheSurfaceIsNotSmooth) {
    const std::vector<std::uint32_t> top{4, 5, 6, 7};
    EXPECT_EQ(touched(prism(4)), (Counts{0, 0}));
    EXPECT_EQ(touched(prism(5)), (Counts{0, 0}));
    EXPECT_EQ(touched(icosahedron(), 3, Scheme::loop), (Counts{0, 0}));
    EXPECT_EQ(touched(withCreases(prism(4), top, 10)), (Counts{4, 4}));
    EXPECT_EQ(touched(withCreases(prism(4), top, 2.5F)), (Counts{0, 0}));
    EXPECT_EQ(touched(withCreases(prism(4), top, 2.5F), 2), (Counts{4, 4}));
    EXPECT_EQ(touched(withCreases(prism(4), top, 10), 10), (Counts{4, 4}));
    EXPECT_EQ(touched(withSharpVertex(prism(4), 2, 10)), (Counts{0, 1}));
    EXPECT_EQ(touched(withSharpVertex(prism(4), 2, 10), 10), (Counts{0, 1}));
    EXPECT_EQ(touched(withSharpVertex(prism(4), 2, 2)), (Counts{0, 0}));
    EXPECT_EQ(touched(withSharpVertex(prism(4), 2, 2), 1), (Counts{0, 1}));
    EXPECT_EQ(touched(withCreases(prism(5), {5, 6, 7, 8, 9}, 10)), (Counts{10, 10}));
    EXPECT_EQ(touched(sheet(4, 3)), (Counts{14, 14}));
    EXPECT_EQ(touched(fins()), (Counts{10, 8}));
    EXPECT_EQ(touched(test::nonManifoldEdge()), (Counts{1, 2}));
    EXPECT_EQ(touched(twistedPair()), (Counts{7, 6}));
    EXPECT_EQ(touched(test::nonManifoldVertex()), (Counts{0, 1}));
    EXPECT_EQ(touched(prism(5), 3, Scheme::bilinear), (Counts{35, 22}));
}

// Chaikin's rule averages sharpness along a crease: an edge below the limit beside one above it may stay sharp.
TEST(Touches, CountChaikinNeighboursAsSharp) {
    Cage cage = withChaikin(withCreases(prism(4), {4, 5, 6, 7}, 2));
    cage.creaseSharpness[0] = 8;
    EXPECT_EQ(touched(cage, 3), (Counts{4, 4}));
    cage.creaseSharpness[0] = 3;
    EXPECT_EQ(touched(cage, 3), (Counts{0, 0}));
}

TEST(Touches, NameAllFacesOfANonManifoldEdge) {
    const Surface surface = buildSurface(fins(), {});
    const auto isShared = [](const Edge& edge) { return edge.touchCount == 3; };
    EXPECT_EQ(std::count_if(surface.edges.begin(), surface.edges.end(), isShared), 1);
}

TEST(Touches, NameAllFansOfAVertex) {
    const Surface surface = buildSurface(test::nonManifoldVertex(), {});
    std::vector<std::uint32_t> faces;
    for (const Corner& corner : surface.corners) {
        const auto touches = touchesOf(surface, corner);
        const bool isMeeting = std::any_of(touches.begin(), touches.end(), [](const Touch& t) { return t.face < 6; }) &&
                               std::any_of(touches.begin(), touches.end(), [](const Touch& t) { return t.face >= 6; });
        if (!isMeeting) continue;
        for (const Touch& touch : touches) faces.push_back(touch.face);
    }
    EXPECT_EQ(faces, (std::vector<std::uint32_t>{1, 3, 5, 6, 8, 10}));
}

TEST(Touches, LeaveHolesOut) {
    const Surface surface = buildSurface(withHoles(withCreases(prism(4), {4, 5, 6, 7}, 10), {5}), {});
    for (const Touch& touch : surface.touches) EXPECT_NE(touch.face, 5u);
    for (const Edge& edge : surface.edges) EXPECT_LE(edge.touchCount, 1u);
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

TEST(Owners, KnowWhetherTheSurfaceIsClosed) {
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

// Edges and corners, who owns them, and which faces share a direction of displacement there (src/README.md,
// "Watertightness").
//
//   corner quads of an n-gon (n = 3)       side i of an n-gon runs from its corner i to corner i+1; quad i of its n
//   quads
//              2                           sits at corner i:
//             / \                              corner 0  n-gon's corner i      side 0  along side i to its middle
//            / 2 \                             corner 1  middle of side i      side 1  middle to centre: edge shared
//           +-. .-+                            corner 2  centre of the n-gon   side 2  centre to middle: edge shared
//          / 0 + 1 \                           corner 3  middle of side i-1    side 3  along side i-1 from its middle
//         /    |    \                      .
//        0 --- + --- 1                     An edge of the cage with an n-gon on any side is two edges here.
#include <algorithm>
#include <numeric>

#include "surface/far.h"

namespace relief {
namespace {

/// Whether the faces of an edge have different normals there and displace in a shared direction, and whether their
/// texture coordinates differ.
struct EdgeKind {
    bool isShared, isSeam;
};

/// Side `side` of the cage's face `face`.
struct SideUse {
    int face;
    int side;
};

class OwnerBuilder {
public:
    OwnerBuilder(Surface& surface, const FarTables& tables, const Cage& cage)
        : surface_(surface), cage_(cage), level_(tables.refiner->GetLevel(0)), ptex_(*tables.refiner),
          isBilinear_(surface.scheme == Scheme::bilinear), sharpLimit_(sharpLimit(cage, tables.isolation)) {}

    void build() {
        gatherUses();
        addVertexCorners();
        for (int edge = 0; edge < level_.GetNumEdges(); ++edge) {
            if (uses_[edge].empty()) continue;
            if (isSplit(uses_[edge]))
                addSplitEdge(edge);
            else
                addWholeEdge(edge);
        }
        for (int face = 0; face < level_.GetNumFaces(); ++face)
            if (!level_.IsFaceHole(face) && isNgon(face)) addInside(face);
        markBoundary();
    }

private:
    static float sharpLimit(const Cage& cage, int isolation) {
        // Chaikin's rule hands sharpness on to neighbours, so one edge past the limit can hold all the others sharp.
        const auto isPast = [&](float sharpness) { return sharpness > float(isolation); };
        const bool isAnyPast = std::any_of(cage.creaseSharpness.begin(), cage.creaseSharpness.end(), isPast);
        return cage.creaseMethod == CreaseMethod::chaikin && isAnyPast ? 0 : float(isolation);
    }

    [[nodiscard]] int sizeOf(int face) const { return level_.GetFaceVertices(face).size(); }
    [[nodiscard]] bool isNgon(int face) const { return sizeOf(face) != surface_.sideCount; }
    [[nodiscard]] bool isSplit(const std::vector<SideUse>& uses) const {
        return std::any_of(uses.begin(), uses.end(), [&](const SideUse& use) { return isNgon(use.face); });
    }
    [[nodiscard]] int startVertex(const SideUse& use) const { return level_.GetFaceVertices(use.face)[use.side]; }
    [[nodiscard]] int endVertex(const SideUse& use) const {
        return level_.GetFaceVertices(use.face)[(use.side + 1) % sizeOf(use.face)];
    }
    [[nodiscard]] std::uint32_t quadOf(int face, int corner) const {
        return std::uint32_t(ptex_.GetFaceId(face) + (isNgon(face) ? corner % sizeOf(face) : 0));
    }

    // OpenSubdiv makes boundary edges, non-manifold edges and non-manifold vertices infinitely sharp.
    [[nodiscard]] bool sharesDirectionAtEdge(int edge) const {
        return isBilinear_ || level_.IsEdgeInfSharp(edge) || level_.GetEdgeSharpness(edge) > sharpLimit_;
    }

    [[nodiscard]] bool sharesDirectionAtVertex(int vertex) const {
        const auto edges = level_.GetVertexEdges(vertex);
        return isBilinear_ || level_.IsVertexInfSharp(vertex) || level_.GetVertexSharpness(vertex) > sharpLimit_ ||
               std::any_of(edges.begin(), edges.end(), [&](int edge) { return sharesDirectionAtEdge(edge); });
    }

    /// True when two faces of the edge have texture coordinates of their own at one of its ends.
    [[nodiscard]] bool isSeam(const std::vector<SideUse>& uses) const {
        if (!cage_.hasTexCoords()) return false;
        const auto texCorner = [&](const SideUse& use, int vertex) {
            const int corner = startVertex(use) == vertex ? use.side : (use.side + 1) % sizeOf(use.face);
            return cage_.texCorners[firstCorners_[use.face] + std::size_t(corner)];
        };
        const int start = startVertex(uses.front()), end = endVertex(uses.front());
        return std::any_of(uses.begin(), uses.end(), [&](const SideUse& use) {
            return texCorner(use, start) != texCorner(uses.front(), start) ||
                   texCorner(use, end) != texCorner(uses.front(), end);
        });
    }

    // A face that runs along two vertices twice has two edges there: the first stands for both.
    void gatherUses() {
        uses_.resize(level_.GetNumEdges());
        surface_.isClosed = true;
        for (int face = 0; face < level_.GetNumFaces(); ++face) {
            firstCorners_.push_back(face == 0 ? 0 : firstCorners_.back() + std::size_t(sizeOf(face - 1)));
            const bool isHole = level_.IsFaceHole(face);
            surface_.isClosed = surface_.isClosed && !isHole;
            for (int side = 0; side < sizeOf(face); ++side) {
                const SideUse use{face, side};
                const int edge = level_.FindEdge(startVertex(use), endVertex(use));
                surface_.isClosed = surface_.isClosed && !level_.IsEdgeBoundary(edge);
                if (!isHole) uses_[edge].push_back(use);
            }
        }
    }

    // --- corners

    /// A face at a corner, and how many drawn faces its smooth sector has there.
    struct CornerIncidence {
        Incidence incidence;
        std::uint32_t sectorFaces;
    };

    /// Adds a corner that belongs to the lowest face.
    std::uint32_t addCorner(std::vector<CornerIncidence>& incidences, bool sharesDirection) {
        std::ranges::stable_sort(incidences, {}, [](const CornerIncidence& t) { return t.incidence.face; });
        Corner corner{incidences.front().incidence, std::uint32_t(surface_.incidences.size()), 0, 0};
        if (sharesDirection) corner.incidenceCount = std::uint32_t(incidences.size());
        for (std::uint32_t i = 0; i < corner.incidenceCount; ++i) {
            surface_.incidences.push_back(incidences[i].incidence);
            surface_.sectorFaces.push_back(incidences[i].sectorFaces);
        }
        surface_.corners.push_back(corner);
        return std::uint32_t(surface_.corners.size() - 1);
    }

    static void sortByFace(std::vector<Incidence>& incidences) {
        std::stable_sort(incidences.begin(), incidences.end(),
                         [](const Incidence& a, const Incidence& b) { return a.face < b.face; });
    }

    std::uint32_t addIncidences(const std::vector<Incidence>& incidences) {
        surface_.incidences.insert(surface_.incidences.end(), incidences.begin(), incidences.end());
        surface_.sectorFaces.resize(surface_.incidences.size(), 1);
        return std::uint32_t(incidences.size());
    }

    /// Drawn faces of the smooth sector of each face around the vertex, in the order of its faces. Faces that share a
    /// smooth edge there are of one sector.
    [[nodiscard]] std::vector<std::uint32_t> sectorsAround(int vertex) const {
        const auto faces = level_.GetVertexFaces(vertex);
        std::vector<int> sector(faces.size());
        std::iota(sector.begin(), sector.end(), 0);
        for (const int edge : level_.GetVertexEdges(vertex)) {
            const auto sides = level_.GetEdgeFaces(edge);
            if (sharesDirectionAtEdge(edge) || sides.size() != 2) continue;
            const int joined = sector[faces.FindIndex(sides[0])], old = sector[faces.FindIndex(sides[1])];
            std::ranges::replace(sector, old, joined);
        }
        std::vector<std::uint32_t> drawn(faces.size(), 0), counts(faces.size());
        for (int i = 0; i < faces.size(); ++i) drawn[sector[i]] += level_.IsFaceHole(faces[i]) ? 0 : 1;
        for (int i = 0; i < faces.size(); ++i) counts[i] = drawn[sector[i]];
        return counts;
    }

    void addVertexCorners() {
        cornerOfVertex_.assign(level_.GetNumVertices(), kNoPatch);
        for (int vertex = 0; vertex < level_.GetNumVertices(); ++vertex) {
            const auto faces = level_.GetVertexFaces(vertex);
            const auto positions = level_.GetVertexFaceLocalIndices(vertex);
            const bool sharesDirection = sharesDirectionAtVertex(vertex);
            std::vector<std::uint32_t> sectors(faces.size(), 1);
            if (sharesDirection) sectors = sectorsAround(vertex);
            std::vector<CornerIncidence> incidences;
            for (int i = 0; i < faces.size(); ++i) {
                if (level_.IsFaceHole(faces[i])) continue;
                const int corner = isNgon(faces[i]) ? 0 : positions[i];
                incidences.push_back({{quadOf(faces[i], positions[i]), std::uint32_t(corner), 0, 0}, sectors[i]});
            }
            if (!incidences.empty()) cornerOfVertex_[vertex] = addCorner(incidences, sharesDirection);
        }
    }

    /// The middle of a split edge is a corner of n-gons' quads and a point on the sides of quads.
    std::uint32_t addMiddleCorner(const std::vector<SideUse>& uses, bool sharesDirection) {
        std::vector<CornerIncidence> incidences;
        for (const SideUse& use : uses) {
            if (isNgon(use.face)) {
                incidences.push_back({{quadOf(use.face, use.side), 1, 0, 0}, 2});
                incidences.push_back({{quadOf(use.face, use.side + 1), 3, 0, 0}, 2});
            } else {
                incidences.push_back({{quadOf(use.face, 0), std::uint32_t(use.side), 0.5F, 0.5F}, 1});
            }
        }
        return addCorner(incidences, sharesDirection);
    }

    // --- edges

    void setSide(const Incidence& incidence, std::uint32_t edge, bool isReversed, std::uint32_t flags = 0) {
        surface_.faces[incidence.face].sides[incidence.side] = edge | flags | (isReversed ? kSideReversed : 0);
    }

    /// Adds an edge whose first incidence is its owner.
    void addEdge(std::vector<Incidence> incidences, std::uint32_t start, std::uint32_t end, std::uint32_t partner,
                 const EdgeKind& kind) {
        Edge edge{incidences.front(), {start, end}, std::uint32_t(surface_.incidences.size()), 0, partner, 0};
        if (incidences.size() == 1) edge.flags |= kOnBoundary;
        if (kind.isSeam) edge.flags |= kOnSeam;
        sortByFace(incidences);
        if (kind.isShared) edge.incidenceCount = addIncidences(incidences);
        surface_.edges.push_back(edge);
    }

    void addWholeEdge(int cageEdge) {
        const auto& uses = uses_[cageEdge];
        const auto edge = std::uint32_t(surface_.edges.size());
        const int start = startVertex(uses.front());
        std::vector<Incidence> incidences;
        for (const SideUse& use : uses) {
            const bool isReversed = startVertex(use) != start;
            Incidence incidence{quadOf(use.face, 0), std::uint32_t(use.side), 0, 1};
            if (isReversed) std::swap(incidence.start, incidence.end);
            incidences.push_back(incidence);
            setSide(incidence, edge, isReversed);
        }
        addEdge(incidences, cornerOfVertex_[start], cornerOfVertex_[endVertex(uses.front())], edge,
                {sharesDirectionAtEdge(cageEdge), isSeam(uses)});
    }

    /// Half 0 or 1 of a side in the direction of its face.
    [[nodiscard]] Incidence halfSide(const SideUse& use, int half) const {
        if (!isNgon(use.face))
            return {quadOf(use.face, 0), std::uint32_t(use.side), 0.5F * float(half), 0.5F * float(half + 1)};
        if (half == 0) return {quadOf(use.face, use.side), 0, 0, 1};
        return {quadOf(use.face, use.side + 1), 3, 0, 1};
    }

    void addSplitEdge(int cageEdge) {
        const auto& uses = uses_[cageEdge];
        const EdgeKind kind{sharesDirectionAtEdge(cageEdge), isSeam(uses)};
        const int start = startVertex(uses.front());
        const std::uint32_t middle = addMiddleCorner(uses, kind.isShared);
        const std::uint32_t ends[] = {cornerOfVertex_[start], middle, cornerOfVertex_[endVertex(uses.front())]};
        const auto first = std::uint32_t(surface_.edges.size());
        for (int half = 0; half < 2; ++half) {
            std::vector<Incidence> incidences;
            for (const SideUse& use : uses) {
                const bool isReversed = startVertex(use) != start;
                Incidence incidence = halfSide(use, isReversed ? 1 - half : half);
                if (isReversed) std::swap(incidence.start, incidence.end);
                incidences.push_back(incidence);
                if (isNgon(use.face))
                    setSide(incidence, first + half, isReversed);
                else
                    setSide(incidence, first, isReversed, kSideSplit);
            }
            addEdge(incidences, ends[half], ends[half + 1], first + 1 - half, kind);
        }
    }

    /// The corner where side 0 of the n-gon's quad `i` ends.
    [[nodiscard]] std::uint32_t middleOfSide(int face, int i) const {
        const std::uint32_t side = surface_.faces[quadOf(face, i)].sides[0];
        return surface_.edges[side & kSideEdgeMask].corners[(side & kSideReversed) ? 0 : 1];
    }

    /// The centre of an n-gon and the edges that run from its sides' middles to the centre.
    void addInside(int face) {
        const int size = sizeOf(face);
        std::vector<CornerIncidence> incidences;
        incidences.reserve(size);
        for (int i = 0; i < size; ++i) incidences.push_back({{quadOf(face, i), 2, 0, 0}, 1});
        const std::uint32_t center = addCorner(incidences, isBilinear_);
        for (int i = 0; i < size; ++i) {
            const std::uint32_t middle = middleOfSide(face, i);
            const auto edge = std::uint32_t(surface_.edges.size());
            Incidence inward{quadOf(face, i), 1, 0, 1}, outward{quadOf(face, i + 1), 2, 0, 1};
            const bool isInward = inward.face < outward.face;
            setSide(inward, edge, !isInward);
            setSide(outward, edge, isInward);
            if (isInward) {
                std::swap(outward.start, outward.end);
                addEdge({inward, outward}, middle, center, edge, {isBilinear_, false});
            } else {
                std::swap(inward.start, inward.end);
                addEdge({outward, inward}, center, middle, edge, {isBilinear_, false});
            }
        }
    }

    void markBoundary() {
        for (const Edge& edge : surface_.edges)
            if ((edge.flags & kOnBoundary) != 0)
                for (const std::uint32_t corner : edge.corners) surface_.corners[corner].flags |= kOnBoundary;
    }

    Surface& surface_;
    const Cage& cage_;
    const Far::TopologyLevel& level_;
    Far::PtexIndices ptex_;
    bool isBilinear_;
    float sharpLimit_;                       ///< edges and vertices sharper than this stay sharp in the limit
    std::vector<std::vector<SideUse>> uses_; ///< drawn faces on each edge of the cage, in index order
    std::vector<std::uint32_t> cornerOfVertex_;
    std::vector<std::size_t> firstCorners_; ///< of each face, into the cage's corners
};

} // namespace

void fillOwners(Surface& surface, const FarTables& tables, const Cage& cage) {
    OwnerBuilder(surface, tables, cage).build();
}

} // namespace relief

// Internal: walks over the faces of a refinement level around a vertex.
#pragma once

#include "surface/far.h"

namespace relief {

using Far::TopologyLevel;

/// A corner of a face of a level.
struct FaceCorner {
    int face = 0, corner = 0;
};

/// The faces around a vertex between two sharp edges, or all of them, counter-clockwise.
struct Sector {
    CapPattern pattern;            ///< `face` is the one that was asked for
    std::vector<FaceCorner> faces; ///< around a smooth vertex from the one that was asked for on

    [[nodiscard]] bool isRegularInside() const {
        const int n = pattern.sideCount == 4 ? 4 : 6;
        return pattern.isClosed && pattern.rule == VertexRule::smooth && !pattern.hasDart && pattern.faceCount == n;
    }
    [[nodiscard]] bool isRegularCrease() const {
        const int n = pattern.sideCount == 4 ? 2 : 3;
        return !pattern.isClosed && pattern.rule == VertexRule::crease && pattern.faceCount == n;
    }
};

/// OpenSubdiv's own patch builder reads the rules of face-varying values there; Far does not offer them.
struct RefinerAccess : Far::TopologyRefiner {
    static const OpenSubdiv::Vtr::internal::FVarLevel& valuesOf(const Far::TopologyRefiner& refiner, int level) {
        using Levels = const OpenSubdiv::Vtr::internal::Level& (Far::TopologyRefiner::*)(int) const;
        const Levels levels = &RefinerAccess::getLevel;
        return (refiner.*levels)(level).getFVarLevel(0);
    }
};

/// Walks over the faces of a level: those of the surface, or of the texture coordinates, which end at their seams.
class LevelWalker {
public:
    LevelWalker(const TopologyLevel& level, int sideCount,
                const OpenSubdiv::Vtr::internal::FVarLevel* texture = nullptr)
        : level_(level), texture_(texture), sideCount_(sideCount) {}

    [[nodiscard]] int vertexAt(FaceCorner at) const { return level_.GetFaceVertices(at.face)[at.corner]; }
    [[nodiscard]] int texValueAt(FaceCorner at) const { return level_.GetFaceFVarValues(at.face)[at.corner]; }
    [[nodiscard]] FaceCorner turned(FaceCorner at, int step) const { return {at.face, next(at.corner, step)}; }

    /// The vertex of a corner, in the face on the other side of the edge that leaves the corner: clockwise around it.
    [[nodiscard]] std::optional<FaceCorner> before(FaceCorner at) const {
        const auto other = across(at, 0);
        if (!other) return {};
        return turned(*other, 1);
    }
    /// The vertex of a corner, in the face on the other side of the edge that arrives at the corner.
    [[nodiscard]] std::optional<FaceCorner> after(FaceCorner at) const { return across(at, -1); }

    /// The faces around the vertex of a corner, and its rule. Nothing where rules are semi-sharp or the level ends.
    [[nodiscard]] std::optional<Sector> sectorAt(FaceCorner start) const;

    /// The face beyond the edge that leaves the corner `step` corners on, named by its corner at the end of that edge.
    [[nodiscard]] std::optional<FaceCorner> across(FaceCorner at, int step) const;

private:
    [[nodiscard]] int next(int corner, int step) const { return (corner + step + sideCount_) % sideCount_; }

    [[nodiscard]] bool isSharp(int edge) const {
        return level_.IsEdgeInfSharp(edge) || level_.IsEdgeBoundary(edge) || level_.IsEdgeNonManifold(edge) ||
               isSeam(edge);
    }
    [[nodiscard]] bool isSeam(int edge) const { return texture_ && !level_.DoesEdgeFVarTopologyMatch(edge); }

    /// The rule of a texture coordinate, where it is not the vertex's.
    bool setTextureRule(CapPattern& pattern, FaceCorner at) const;

    bool setRule(CapPattern& pattern, FaceCorner at) const;

    [[nodiscard]] bool addFaces(Sector& sector, FaceCorner first, FaceCorner start, bool isClosed) const;

    /// The sharp edges at both ends of a sector are one: a dart. The texture coordinates along a seam are two.
    [[nodiscard]] bool isOneSharpEdge(const Sector& sector) const;

    const TopologyLevel& level_;
    const OpenSubdiv::Vtr::internal::FVarLevel* texture_;
    int sideCount_;
};

/// The corners of faces whose vertices are the points around a cap.
class CapWalker {
public:
    explicit CapWalker(const LevelWalker& level) : level_(level) {}

    /// Finds the one corner of a face that is not regular, and the points around it.
    bool find(int face, int sideCount, int levelCount);

    [[nodiscard]] const CapPattern& pattern() const { return sector_.pattern; }
    [[nodiscard]] int corner() const { return at_.corner; }
    /// The points around the cap, without the sums.
    [[nodiscard]] const std::vector<FaceCorner>& points() const { return points_; }
    /// The vertex, the other ends of all edges, and the far corners of all faces if they have four sides.
    [[nodiscard]] std::vector<FaceCorner> ring() const;

private:
    bool collect();

    /// Appends the vertex `step` corners on from a corner, by which a face is named.
    void add(FaceCorner face, int step) { points_.push_back(level_.turned(face, step)); }

    /// In lattice coordinates: the cap's corners are (0,0), (1,0), (1,1), (0,1).
    bool collectOuterOfQuads();

    /// In lattice coordinates: the cap's corners are (0,0), (1,0), (0,1).
    bool collectOuterOfTriangles();

    const LevelWalker& level_;
    Sector sector_;
    FaceCorner at_;
    std::vector<FaceCorner> points_;
};

} // namespace relief

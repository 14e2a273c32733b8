// Internal: the limit surface in faces at extraordinary vertices, exactly, at any distance from the vertex.
//
// Such a face has one corner where the rules of subdivision are not the regular ones. One refinement leaves three
// regular pieces (bicubic B-splines, or box splines) and a copy of the face, half as large, whose control points are
// A C: A is the matrix of the rules around the vertex and C are the points around the face (Stam, Exact Evaluation of
// Catmull-Clark Subdivision Surfaces at Arbitrary Parameter Values, 1998, sections 3 and 4). At distance 2^-n of the
// vertex the control points of a piece are S A^(n-1) C. Stam writes that by eigenvalues; rules at creases and corners
// have defective matrices, so here are the powers themselves, with what all points have in common taken away:
//
//   p = p0 + 2^-n sum_j b_j(u,v) Q_j,   Q = 2^n S (A - 1 l)^(n-1) (C - p0),   p0 = l C
//
// where l is the left eigenvector of the eigenvalue 1. All numbers are of the size of the face's sides, whatever n is.
#pragma once

#include <compare>
#include <vector>

#include <Eigen/Dense>

#include "shared/surface.h"
#include "surface/gregory.h"

namespace relief {

/// How a vertex itself is refined.
enum class VertexRule { smooth, crease, corner };

/// The rules around the vertex of a cap, in the order of its faces counter-clockwise.
struct CapPattern {
    int sideCount = 4;    ///< of the faces
    int faceCount = 0;    ///< around the vertex, between two sharp edges where it is not closed
    int face = 0;         ///< which of these the cap is; 0 where all are alike
    bool isClosed = true; ///< faces all around
    bool hasDart = false; ///< closed, with one sharp edge, which lies before face 0
    VertexRule rule = VertexRule::smooth;
    /// Edges that count one by one to each side of the cap's own two, and faces to each side of the cap; 0 for all.
    /// Only around smooth vertices without a dart, whose other edges and faces all count alike.
    int window = 0;

    auto operator<=>(const CapPattern&) const = default;

    /// Edges at the vertex; edge j lies before face j.
    [[nodiscard]] int spokeCount() const { return isClosed ? faceCount : faceCount + 1; }
    [[nodiscard]] bool isSharp(int spoke) const {
        return isClosed ? hasDart && spoke % faceCount == 0 : spoke == 0 || spoke == faceCount;
    }
    [[nodiscard]] bool isSharpBefore() const { return isSharp(face); }
    [[nodiscard]] bool isSharpAfter() const { return isSharp(face + 1); }
    /// The first edge and face that count one by one, and how many of each.
    [[nodiscard]] int firstSpoke() const { return window == 0 ? 0 : face - window; }
    [[nodiscard]] int windowSpokeCount() const { return window == 0 ? spokeCount() : 2 * window + 2; }
    [[nodiscard]] int windowFaceCount() const { return window == 0 ? faceCount : 2 * window + 1; }
    /// Points that stand for the whole ring where there is a window: as ringSums() has them.
    [[nodiscard]] int sumCount() const { return window == 0 ? 0 : sideCount == 4 ? 4 : 3; }
    /// Points around the cap: the vertex, the other ends of its edges, the far corners of its faces if they have four
    /// sides, those of capOuterPoints(), then the sums.
    [[nodiscard]] int pointCount() const;
};

/// A point in coordinates of the cap in which its vertex is (0,0), and the cap the unit square or triangle.
struct LatticePoint {
    int x, y;
    auto operator<=>(const LatticePoint&) const = default;
};

/// The points around a cap that are in no face of its vertex, in the order of CapPattern::pointCount.
std::vector<LatticePoint> capOuterPoints(const CapPattern& pattern);

/// The points that stand for the whole ring of a pattern with a window, as rows of weights of the vertex, the other
/// ends of all edges and, of quads, the far corners of all faces: the mean of the ends, of quads the mean of the
/// corners, and the vertex's limit point plus p_u and p_v there (the eigenvectors of the two largest eigenvalues below
/// 1). Each row sums up to 1. A point far along the ring counts in a piece as its neighbours do, down to a level that
/// depends on the window: refinement carries differences from one edge to the next, one edge per level.
Eigen::MatrixXd ringSums(const CapPattern& pattern);

// Pieces are at (1,0), at (1,1) and at (0,1); of triangles at (1,0), in the middle and at (0,1).

/// The matrix A: the points around a cap of half the size as sums of those around the cap.
Eigen::MatrixXd refinementAround(const CapPattern& pattern);

/// What Q is made of.
class CapMatrices {
public:
    /// `levelCount`: levels to prepare; nearer to the vertex the last one goes on.
    CapMatrices(const CapPattern& pattern, int levelCount);

    [[nodiscard]] const CapPattern& pattern() const { return pattern_; }
    [[nodiscard]] int levelCount() const { return int(levels_.size()); }
    /// Of the points around the cap for the limit point of the vertex.
    [[nodiscard]] const Eigen::RowVectorXd& limitWeights() const { return limit_; }
    /// Weights of C - p0 for Q: a row per control point of a piece. `level`: n >= 1.
    [[nodiscard]] const Eigen::MatrixXd& pieceWeights(int level, int piece) const { return levels_[level - 1][piece]; }
    /// Weights of C - p0 for p_u and p_v at the vertex, by the cap's coordinates: two directions that span the tangent
    /// plane. Derivatives there are 0 or infinite for most valences; these have the size of the faces' sides.
    [[nodiscard]] const Eigen::MatrixXd& tangentWeights() const { return tangents_; }

private:
    CapPattern pattern_;
    Eigen::RowVectorXd limit_;
    std::vector<std::array<Eigen::MatrixXd, kCapPieces>> levels_;
    Eigen::MatrixXd tangents_;
};

/// Where a point of a cap lies: on which piece of which level, and there.
struct CapPlace {
    int level = 0;   ///< 0 at the vertex itself
    double size = 0; ///< of a piece there, where the cap is 1: 2^-level, or less where levels have ended
    int piece = 0;
    double u = 0, v = 0;
    double slope = 1; ///< -1 in the turned middle of triangles
};
CapPlace placeInCap(int sideCount, double a, double b, int levelCount);

/// Weights of the control points of a piece: 16, or 12 in OpenSubdiv's order.
std::vector<Jet> pieceBasis(int sideCount, double u, double v);

} // namespace relief

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

#include <algorithm>
#include <compare>
#include <vector>

#include <Eigen/Dense>

#include "shared/surface.h"
#include "surface/gregory.h"

namespace relief {

/// Faces around a vertex, between two sharp edges if it has them, whose points count one by one. Evaluations would take
/// too long with more, and tables too much between sharp edges, where each face has its own: 300 kB per face for 64 of
/// them. Vertices of more have windows.
inline constexpr int kMostCapFaces = 64;

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
    /// Beyond a sharp edge that ends the faces there is nothing.
    int window = 0;

    auto operator<=>(const CapPattern&) const = default;

    /// Edges at the vertex; edge j lies before face j.
    [[nodiscard]] int spokeCount() const { return isClosed ? faceCount : faceCount + 1; }
    [[nodiscard]] bool isSharp(int spoke) const {
        return isClosed ? hasDart && spoke % faceCount == 0 : spoke == 0 || spoke == faceCount;
    }
    [[nodiscard]] bool isSharpBefore() const { return isSharp(face); }
    [[nodiscard]] bool isSharpAfter() const { return isSharp(face + 1); }
    /// A vertex whose own rule is that of smooth ones, but not that of all its edges.
    [[nodiscard]] bool isDart() const { return hasDart && rule == VertexRule::smooth; }
    /// The first edge and face that count one by one, and how many of each.
    [[nodiscard]] int firstSpoke() const {
        return window == 0 ? 0 : isClosed ? face - window : std::max(face - window, 0);
    }
    [[nodiscard]] int windowFaceCount() const {
        if (window == 0) return faceCount;
        return (isClosed ? face + window : std::min(face + window, faceCount - 1)) - firstSpoke() + 1;
    }
    [[nodiscard]] int windowSpokeCount() const { return window == 0 ? spokeCount() : windowFaceCount() + 1; }
    /// Points that stand for the whole ring where there is a window: those of ringMeans(), then p0 + p_u and p0 + p_v
    /// at the vertex, which depend on all of the ring. Between sharp edges, but for creases, the deepest level stands
    /// for them.
    [[nodiscard]] int meanCount() const;
    [[nodiscard]] int tangentCount() const;
    [[nodiscard]] int sumCount() const { return meanCount() + tangentCount(); }
    /// The pattern with the same matrices that is the same for all faces far from sharp edges, and for any number of
    /// faces where the vertex's rule does not depend on it. The means and tangents of the ring are not those of it.
    [[nodiscard]] CapPattern ofWindow() const;
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

// The ring of a vertex is the vertex, the other ends of all edges and, of quads, the far corners of all faces. A point
// far along the ring counts in a piece as its neighbours do, down to a level that depends on the window: refinement
// carries differences from one edge to the next, one edge per level.

/// The weights of the ring's points for the vertex's limit point p0.
Eigen::RowVectorXd ringLimit(const CapPattern& pattern);

/// What the rule of a vertex with a window needs of all of its ring, a row per point that sums up to 1: of smooth
/// vertices the mean of the ends, and of quads the mean of the corners; of creases the mean of the sharp edges' ends;
/// at darts, where no few means follow from each other, p0 + 2^n (v_n - p0), v_n the vertex after n = 1, 2, ..
/// refinements. `limit`: ringLimit(), which takes long at darts.
Eigen::MatrixXd ringMeans(const CapPattern& pattern, const Eigen::RowVectorXd& limit);

/// Returns the eigenvalue of waves around a vertex that turn by `angle` radians from one edge to the next. Of quads it
/// is the closed form of Catmull and Clark's: (5 + cos a + cos(a/2) sqrt(18 + 2 cos a)) / 16.
double waveEigenvalue(int sideCount, double angle);

/// The weights of the ring's points for p_u and p_v at the vertex, to either side of the cap's middle: of smooth
/// vertices without a dart the eigenvectors of the two largest eigenvalues below 1, of creases those along and across,
/// of sharp vertices without sharp edges those along the needle and around.
Eigen::MatrixXd ringTangents(const CapPattern& pattern);

// Pieces are at (1,0), at (1,1) and at (0,1); of triangles at (1,0), in the middle and at (0,1).

/// The matrix A: the points around a cap of half the size as sums of those around the cap. Around a dart with
/// a window it maps C - p0 instead of C, and its rows do not sum up to 1.
Eigen::MatrixXd refinementAround(const CapPattern& pattern);

/// The left eigenvector of the eigenvalue 1 of such a matrix, or of the part of it that is the ring's own: weights that
/// sum up to 1 of the points that it refines, for the vertex's limit point. All other eigenvalues are below 2/3.
Eigen::RowVectorXd stationaryRow(const Eigen::MatrixXd& a);

/// What Q is made of.
class CapMatrices {
public:
    /// `levelCount`: levels to prepare; nearer to the vertex the last one goes on.
    CapMatrices(const CapPattern& pattern, int levelCount);

    [[nodiscard]] const CapPattern& pattern() const { return pattern_; }
    [[nodiscard]] int levelCount() const { return int(levels_.size()); }
    /// Weights of the points around the cap for the limit point of the vertex; empty at a dart with a window, whose
    /// limit point depends on the whole ring: see ringLimit().
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

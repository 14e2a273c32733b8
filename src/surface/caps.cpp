#include "surface/caps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Sparse>

#include "base/checks.h"

namespace relief {
namespace {

using Eigen::MatrixXd;
using Eigen::RowVectorXd;

/// OpenSubdiv's order of the control points of a triangle of a box spline, whose corners are (0,0), (1,0) and (0,1).
constexpr LatticePoint kBoxPoints[] = {{0, -1}, {1, -1}, {2, -1}, {-1, 0}, {0, 0},  {1, 0},
                                       {2, 0},  {-1, 1}, {0, 1},  {1, 1},  {-1, 2}, {0, 2}};

/// The points after one refinement as rows of weights over those before.
class CapRefinement {
public:
    explicit CapRefinement(const CapPattern& pattern)
        : pattern_(pattern), outer_(capOuterPoints(pattern)), count_(pattern.pointCount()) {}

    /// A of the rules around the vertex: the same points around a cap of half the size.
    [[nodiscard]] MatrixXd matrix() const {
        MatrixXd a(count_, count_);
        a.row(0) = refinedVertex();
        int row = 1;
        const int first = pattern_.firstSpoke();
        for (int i = 0; i < pattern_.windowSpokeCount(); ++i) a.row(row++) = refinedSpoke(first + i);
        if (pattern_.sideCount == 4)
            for (int i = 0; i < pattern_.windowFaceCount(); ++i) a.row(row++) = facePoint(first + i);
        for (const LatticePoint& p : outer_) a.row(row++) = refined(p);
        for (int i = 0; i < pattern_.meanCount(); ++i) a.row(row++) = refinedMean(i);
        // Tangents are not refined: any row that sums up to 1.
        for (int i = 0; i < pattern_.tangentCount(); ++i) a.row(row++) = refinedVertex();
        RELIEF_CHECK(row == count_);
        return a;
    }

    /// S of a piece: its control points.
    [[nodiscard]] MatrixXd piece(int index) const {
        if (pattern_.sideCount == 3) return trianglePiece(index);
        const int x0 = index == 2 ? 0 : 1, y0 = index == 0 ? 0 : 1;
        MatrixXd s(16, count_);
        for (int i = 0; i < 16; ++i) s.row(i) = control({x0 + i % 4 - 1, y0 + i / 4 - 1});
        return s;
    }

private:
    [[nodiscard]] MatrixXd trianglePiece(int index) const {
        MatrixXd s(12, count_);
        for (int i = 0; i < 12; ++i) {
            const LatticePoint& p = kBoxPoints[i];
            s.row(i) = control(index == 0   ? LatticePoint{1 + p.x, p.y}
                               : index == 2 ? LatticePoint{p.x, 1 + p.y}
                                            : LatticePoint{1 - p.x, 1 - p.y});
        }
        return s;
    }

    [[nodiscard]] RowVectorXd unit(int point) const { return RowVectorXd::Unit(count_, point); }
    [[nodiscard]] RowVectorXd vertex() const { return unit(0); }
    [[nodiscard]] RowVectorXd spoke(int j) const { return unit(1 + placeOf(j, pattern_.windowSpokeCount())); }
    [[nodiscard]] RowVectorXd farCorner(int face) const {
        return unit(1 + pattern_.windowSpokeCount() + placeOf(face, pattern_.windowFaceCount()));
    }
    /// Around the vertex, or at an end of the window: what is wrong there takes more levels to arrive at the cap than
    /// there are.
    [[nodiscard]] int placeOf(int j, int count) const {
        if (pattern_.window == 0) return (j % count + count) % count;
        return std::clamp(j - pattern_.firstSpoke(), 0, count - 1);
    }
    /// A point of the lattice before refinement.
    [[nodiscard]] RowVectorXd at(int x, int y) const {
        const int i = pattern_.face;
        if (x == 0 && y == 0) return vertex();
        if (x == 1 && y == 0) return spoke(i);
        if (x == 0 && y == 1) return spoke(i + 1);
        if (pattern_.sideCount == 4) {
            if (x == 1 && y == 1) return farCorner(i);
            if (x == 1 && y == -1) return farCorner(i - 1);
            if (x == -1 && y == 1) return farCorner(i + 1);
            if (x == 0 && y == -1) return spoke(i - 1);
            if (x == -1 && y == 0) return spoke(i + 2);
        } else {
            if (x == 1 && y == -1) return spoke(i - 1);
            if (x == -1 && y == 1) return spoke(i + 2);
        }
        const auto found = std::ranges::find(outer_, LatticePoint{x, y});
        RELIEF_CHECK(found != outer_.end());
        return unit(count_ - pattern_.sumCount() - int(outer_.end() - found));
    }

    // --- rules at the vertex

    [[nodiscard]] RowVectorXd facePoint(int face) const {
        return 0.25 * (vertex() + spoke(face) + farCorner(face) + spoke(face + 1));
    }

    [[nodiscard]] RowVectorXd refinedVertex() const {
        if (pattern_.rule == VertexRule::corner) return vertex();
        if (pattern_.window > 0 && pattern_.isDart()) return 0.5 * mean(0);
        if (pattern_.rule == VertexRule::crease && pattern_.window > 0) return 0.75 * vertex() + 0.25 * mean(0);
        if (pattern_.rule == VertexRule::crease)
            return 0.75 * vertex() + 0.125 * (spoke(0) + spoke(pattern_.spokeCount() - 1));
        const int n = pattern_.faceCount;
        RowVectorXd around = RowVectorXd::Zero(count_);
        if (pattern_.sideCount == 3) {
            if (pattern_.window > 0) around = n * mean(0);
            for (int j = 0; j < n && pattern_.window == 0; ++j) around += spoke(j);
            const double c = 0.375 + 0.25 * std::cos(2 * std::numbers::pi / n), beta = (0.625 - c * c) / n;
            return (1 - n * beta) * vertex() + beta * around;
        }
        if (pattern_.window > 0) around = n * (mean(0) + meanFacePoint());
        for (int j = 0; j < n && pattern_.window == 0; ++j) around += spoke(j) + facePoint(j);
        return (n - 2.0) / n * vertex() + 1.0 / (double(n) * n) * around;
    }

    // With a window.
    [[nodiscard]] RowVectorXd mean(int i) const { return unit(count_ - pattern_.sumCount() + i); }
    [[nodiscard]] RowVectorXd meanFacePoint() const { return 0.25 * (vertex() + 2 * mean(0) + mean(1)); }
    [[nodiscard]] RowVectorXd refinedMean(int i) const {
        if (pattern_.rule == VertexRule::crease) return 0.5 * (vertex() + mean(0));
        // The vertex of later levels comes nearer, and is drawn twice as large. The last one is never asked for.
        if (pattern_.isDart()) return i + 1 < pattern_.meanCount() ? 0.5 * mean(i + 1) : 0 * mean(i);
        if (i == 1) return meanFacePoint();
        if (pattern_.sideCount == 3) return 0.375 * vertex() + 0.625 * mean(0);
        return 0.25 * (vertex() + mean(0) + 2 * meanFacePoint());
    }

    [[nodiscard]] RowVectorXd refinedSpoke(int j) const {
        if (pattern_.isSharp(j)) return 0.5 * (vertex() + spoke(j));
        if (pattern_.sideCount == 3) return 0.375 * (vertex() + spoke(j)) + 0.125 * (spoke(j - 1) + spoke(j + 1));
        return 0.25 * (vertex() + spoke(j) + facePoint(j) + facePoint(j - 1));
    }

    // --- rules elsewhere: all regular

    /// True on the sharp edges that bound the cap on either side.
    [[nodiscard]] bool isOnCrease(int x, int y) const {
        return (y == 0 && pattern_.isSharpBefore()) || (x == 0 && pattern_.isSharpAfter());
    }

    /// A point of the lattice after refinement, whose (2,0) lies on the (1,0) before.
    [[nodiscard]] RowVectorXd refined(const LatticePoint& p) const {
        const int i = pattern_.face;
        const auto [x, y] = p;
        if (x == 0 && y == 0) return refinedVertex();
        if (x == 1 && y == 0) return refinedSpoke(i);
        if (x == 0 && y == 1) return refinedSpoke(i + 1);
        return pattern_.sideCount == 4 ? refinedQuads(p) : refinedTriangles(p);
    }

    [[nodiscard]] RowVectorXd centerOf(int x, int y) const {
        return 0.25 * (at(x, y) + at(x + 1, y) + at(x, y + 1) + at(x + 1, y + 1));
    }

    [[nodiscard]] RowVectorXd refinedQuads(const LatticePoint& p) const {
        const int i = pattern_.face;
        const auto half = [](int k) { return k >> 1; }; // downwards
        const int x = half(p.x), y = half(p.y);
        const bool isOddX = (p.x & 1) != 0, isOddY = (p.y & 1) != 0;
        // Beside the vertex, where the lattice does not go on around it.
        if (p.x == 0 && p.y == -1) return refinedSpoke(i - 1);
        if (p.x == -1 && p.y == 0) return refinedSpoke(i + 2);
        if (p.x == 1 && p.y == -1) return facePoint(i - 1);
        if (p.x == -1 && p.y == 1) return facePoint(i + 1);
        if (isOddX && isOddY) return centerOf(x, y);
        if (isOddX) {
            if (isOnCrease(p.x, p.y)) return 0.5 * (at(x, y) + at(x + 1, y));
            return 0.25 * (at(x, y) + at(x + 1, y) + centerOf(x, y - 1) + centerOf(x, y));
        }
        if (isOddY) {
            if (isOnCrease(p.x, p.y)) return 0.5 * (at(x, y) + at(x, y + 1));
            return 0.25 * (at(x, y) + at(x, y + 1) + centerOf(x - 1, y) + centerOf(x, y));
        }
        if (isOnCrease(p.x, p.y))
            return 0.75 * at(x, y) + 0.125 * (y == 0 ? at(x - 1, y) + at(x + 1, y) : at(x, y - 1) + at(x, y + 1));
        const RowVectorXd edges = at(x - 1, y) + at(x + 1, y) + at(x, y - 1) + at(x, y + 1);
        const RowVectorXd corners = at(x - 1, y - 1) + at(x + 1, y - 1) + at(x - 1, y + 1) + at(x + 1, y + 1);
        return (36 * at(x, y) + 6 * edges + corners) / 64;
    }

    [[nodiscard]] RowVectorXd refinedTriangles(const LatticePoint& p) const {
        const int i = pattern_.face;
        const auto half = [](int k) { return k >> 1; };
        const int x = half(p.x), y = half(p.y);
        const bool isOddX = (p.x & 1) != 0, isOddY = (p.y & 1) != 0;
        if (p.x == 1 && p.y == -1) return refinedSpoke(i - 1);
        if (p.x == -1 && p.y == 1) return refinedSpoke(i + 2);
        // Edges along x, along y, and from (x + 1, y) to (x, y + 1); the ends first, then what lies opposite.
        const auto edge = [](const RowVectorXd& ends, const RowVectorXd& opposite) -> RowVectorXd {
            return 0.375 * ends + 0.125 * opposite;
        };
        if (isOddX && isOddY) return edge(at(x + 1, y) + at(x, y + 1), at(x, y) + at(x + 1, y + 1));
        if ((isOddX || isOddY) && isOnCrease(p.x, p.y))
            return 0.5 * (at(x, y) + (isOddX ? at(x + 1, y) : at(x, y + 1)));
        if (isOddX) return edge(at(x, y) + at(x + 1, y), at(x, y + 1) + at(x + 1, y - 1));
        if (isOddY) return edge(at(x, y) + at(x, y + 1), at(x + 1, y) + at(x - 1, y + 1));
        if (isOnCrease(p.x, p.y))
            return 0.75 * at(x, y) + 0.125 * (y == 0 ? at(x - 1, y) + at(x + 1, y) : at(x, y - 1) + at(x, y + 1));
        return 0.625 * at(x, y) + 0.0625 * (at(x - 1, y) + at(x + 1, y) + at(x, y - 1) + at(x, y + 1) +
                                            at(x + 1, y - 1) + at(x - 1, y + 1));
    }

    /// A control point of a piece. Beyond a sharp edge it is a phantom point, which makes the edge a spline of its own.
    [[nodiscard]] RowVectorXd control(const LatticePoint& p) const {
        const auto [x, y] = p;
        if (pattern_.sideCount == 4) {
            if (y < 0 && pattern_.isSharpBefore()) return 2 * control({x, 0}) - control({x, 1});
            if (x < 0 && pattern_.isSharpAfter()) return 2 * control({0, y}) - control({1, y});
        } else {
            if (y < 0 && pattern_.isSharpBefore()) return control({x - 1, 0}) + control({x, 0}) - control({x - 1, 1});
            if (x < 0 && pattern_.isSharpAfter()) return control({0, y - 1}) + control({0, y}) - control({1, y - 1});
        }
        return refined(p);
    }

    CapPattern pattern_;
    std::vector<LatticePoint> outer_;
    int count_;
};

constexpr int kSquarings = 24; ///< 2^24 refinements: what shrinks faster is gone, however many faces there are

/// The projection to the eigenvectors of a matrix's largest eigenvalue, which must be real, and other ones smaller.
MatrixXd dominantProjection(const MatrixXd& matrix) {
    MatrixXd x = matrix / matrix.norm();
    for (int i = 0; i < kSquarings; ++i) {
        x = (x * x).eval();
        x /= x.norm();
    }
    return x / (x * x).norm() * x.norm();
}

/// The derivatives along u and v of a piece at its corner nearest to the vertex, where both coordinates are alike.
MatrixXd diagonalTangents(int sideCount, const MatrixXd& piece) {
    const std::vector<Jet> basis = sideCount == 4 ? pieceBasis(4, 0, 0) : pieceBasis(3, 0.5, 0.5);
    const double sign = sideCount == 4 ? 1 : -1;
    MatrixXd rows = MatrixXd::Zero(2, piece.cols());
    for (int j = 0; j < piece.rows(); ++j) {
        rows.row(0) += sign * basis[j].u * piece.row(j);
        rows.row(1) += sign * basis[j].v * piece.row(j);
    }
    return rows;
}

/// Around a smooth vertex the two directions of the largest eigenvalues below 1.
MatrixXd smoothTangents(const CapPattern& pattern, const MatrixXd& deflated, const MatrixXd& piece) {
    MatrixXd rest = deflated;
    // Around a vertex of two faces 1/4 twice, and -1/4: normals tilt to and fro. In the middle of both are the first.
    if (pattern.faceCount == 2) rest = 0.5 * (MatrixXd::Identity(rest.rows(), rest.cols()) + rest);
    MatrixXd projection = MatrixXd::Zero(rest.rows(), rest.cols());
    for (int rank = 0; rank < 2;) {
        const MatrixXd p = dominantProjection(rest);
        rank += std::max(int(std::lround(p.trace())), 1);
        projection += p;
        rest -= rest * p;
    }
    return diagonalTangents(pattern.sideCount, 2 * piece * projection);
}

/// At a sharp vertex in the midst of smooth edges, which is the tip of a needle: along the needle, and around it, which
/// shrinks faster.
MatrixXd needleTangents(const CapPattern& pattern, const MatrixXd& deflated, const MatrixXd& piece) {
    const MatrixXd along = dominantProjection(deflated);
    const MatrixXd around = dominantProjection(deflated - deflated * along);
    const MatrixXd a = diagonalTangents(pattern.sideCount, 2 * piece * along);
    const MatrixXd b = diagonalTangents(pattern.sideCount, 2 * piece * around);
    const RowVectorXd sum = a.row(0) + a.row(1);
    RowVectorXd difference = b.row(1) - b.row(0);
    difference *= sum.norm() / difference.norm(); // a direction: of a similar length
    MatrixXd rows(2, deflated.rows());
    rows << 0.5 * (sum - difference), 0.5 * (sum + difference);
    return rows;
}

/// Returns the tangents of the ring: the other points around the cap do not count.
MatrixXd tangentsOfRing(const CapPattern& pattern, Eigen::Index count) {
    const MatrixXd ring = ringTangents(pattern);
    MatrixXd rows = MatrixXd::Zero(2, count);
    rows.leftCols(ring.cols()) = ring;
    return rows;
}

/// At a crease around one face: along it, and what is left of both tangents where those cancel; the matrix may have no
/// second eigenvector. Both turned as ringTangents() are.
MatrixXd loneFaceTangents(const MatrixXd& deepest) {
    const Eigen::Index count = deepest.cols();
    const RowVectorXd along = 0.5 * (RowVectorXd::Unit(count, 1) - RowVectorXd::Unit(count, 2));
    RowVectorXd across = deepest.colwise().sum();
    across *= along.norm() / across.norm(); // a direction: of a similar length
    MatrixXd rows(2, count);
    for (int i = 0; i < 2; ++i) {
        const double angle = std::numbers::pi * (i == 0 ? 0.25 : 0.75);
        rows.row(i) = std::cos(angle) * along + std::sin(angle) * across;
    }
    return rows;
}

} // namespace

RowVectorXd stationaryRow(const MatrixXd& a) {
    constexpr int kRefinements = 120; // (2/3)^120 < 1e-20
    RowVectorXd row = RowVectorXd::Unit(a.rows(), 0);
    for (int i = 0; i < kRefinements; ++i) row = (row * a).eval();
    return row / row.sum();
}

std::vector<LatticePoint> capOuterPoints(const CapPattern& pattern) {
    std::vector<LatticePoint> points;
    if (!pattern.isSharpBefore()) points.push_back({2, -1});
    if (pattern.sideCount == 4)
        points.insert(points.end(), {{2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}});
    else
        points.insert(points.end(), {{2, 0}, {1, 1}, {0, 2}});
    if (!pattern.isSharpAfter()) points.push_back({-1, 2});
    return points;
}

MatrixXd refinementAround(const CapPattern& pattern) { return CapRefinement(pattern).matrix(); }

CapMatrices::CapMatrices(const CapPattern& pattern, int levelCount) : pattern_(pattern) {
    const CapRefinement refinement(pattern);
    const MatrixXd a = refinementAround(pattern);
    // Without the eigenvalue 1 of what all points share, powers of the matrix shrink: they are scaled by 2 per level.
    MatrixXd deflated = a;
    if (pattern.window == 0 || !pattern.isDart()) {
        limit_ = stationaryRow(a);
        deflated -= Eigen::VectorXd::Ones(a.rows()) * limit_;
    }

    // Each level from the one before, twice as large. A's rows are short, and what the limit point takes away is one
    // number per row of weights.
    const Eigen::SparseMatrix<double> rules = a.sparseView();
    std::array<MatrixXd, kCapPieces> pieces;
    for (int piece = 0; piece < int(kCapPieces); ++piece) {
        const MatrixXd s = refinement.piece(piece);
        pieces[piece] = s;
        MatrixXd weights = 2 * s;
        if (limit_.size() > 0) weights -= 2 * Eigen::VectorXd::Ones(s.rows()) * limit_;
        for (int level = 1; level <= std::max(levelCount, int(kCapLevels)); ++level) {
            if (level > 1) {
                weights = (2 * weights * rules).eval();
                if (limit_.size() > 0) weights -= (weights.rowwise().sum() * limit_).eval();
            }
            if (piece == 0) levels_.emplace_back();
            levels_[level - 1][piece] = weights;
        }
    }
    // Directions at the vertex itself, by its rules. The deepest level of a table stands for the limit between sharp
    // edges. At darts of many faces, where it grows by up to 1.31 per level, it is about as long as the first. Vertices
    // of many faces have the same directions whether or not there is a window, which depends on how many levels there
    // are.
    const auto tangentsOf = [&](int level) { return diagonalTangents(pattern.sideCount, levels_[level - 1][1]); };
    const bool isLarge = pattern.window > 0 || pattern.faceCount > kMostCapFaces;
    MatrixXd deepest = tangentsOf(int(kCapLevels));
    if (isLarge && pattern.isDart()) deepest *= std::pow(2 * waveEigenvalue(pattern.sideCount, 0), 1 - int(kCapLevels));
    const bool isNeedle = pattern.isClosed && !pattern.hasDart;
    if (pattern.tangentCount() > 0)
        tangents_ = MatrixXd::Identity(a.rows(), a.rows()).bottomRows(2);
    else if (isLarge && !pattern.hasDart && (isNeedle || pattern.rule != VertexRule::corner))
        tangents_ = tangentsOfRing(pattern, a.cols());
    else if (isLarge || (pattern.rule == VertexRule::corner && !isNeedle))
        tangents_ = deepest;
    else if (pattern.rule == VertexRule::corner)
        tangents_ = needleTangents(pattern, deflated, pieces[1]);
    else if (pattern.rule == VertexRule::smooth)
        tangents_ = smoothTangents(pattern, deflated, pieces[1]);
    else
        tangents_ = pattern.faceCount == 1 ? loneFaceTangents(deepest) : tangentsOfRing(pattern, a.cols());
    levels_.resize(levelCount);
}

} // namespace relief

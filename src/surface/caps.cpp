#include "surface/caps.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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
        for (int spoke = 0; spoke < pattern_.spokeCount(); ++spoke) a.row(row++) = refinedSpoke(spoke);
        if (pattern_.sideCount == 4)
            for (int face = 0; face < pattern_.faceCount; ++face) a.row(row++) = facePoint(face);
        for (const LatticePoint& p : outer_) a.row(row++) = refined(p);
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
    [[nodiscard]] RowVectorXd spoke(int j) const {
        const int n = pattern_.spokeCount();
        return unit(1 + (j % n + n) % n);
    }
    [[nodiscard]] RowVectorXd farCorner(int face) const {
        const int n = pattern_.faceCount;
        return unit(1 + pattern_.spokeCount() + (face % n + n) % n);
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
        return unit(count_ - int(outer_.end() - found));
    }

    // --- rules at the vertex

    [[nodiscard]] RowVectorXd facePoint(int face) const {
        return 0.25 * (vertex() + spoke(face) + farCorner(face) + spoke(face + 1));
    }

    [[nodiscard]] RowVectorXd refinedVertex() const {
        if (pattern_.rule == VertexRule::corner) return vertex();
        if (pattern_.rule == VertexRule::crease)
            return 0.75 * vertex() + 0.125 * (spoke(0) + spoke(pattern_.spokeCount() - 1));
        const int n = pattern_.faceCount;
        RowVectorXd around = RowVectorXd::Zero(count_);
        if (pattern_.sideCount == 3) {
            for (int j = 0; j < n; ++j) around += spoke(j);
            const double c = 0.375 + 0.25 * std::cos(2 * std::numbers::pi / n), beta = (0.625 - c * c) / n;
            return (1 - n * beta) * vertex() + beta * around;
        }
        for (int j = 0; j < n; ++j) around += spoke(j) + facePoint(j);
        return (n - 2.0) / n * vertex() + 1.0 / (double(n) * n) * around;
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
    MatrixXd rest = deflated, projection = MatrixXd::Zero(rest.rows(), rest.cols());
    for (int rank = 0; rank < 2;) {
        const MatrixXd p = dominantProjection(rest);
        rank += std::max(int(std::lround(p.trace())), 1);
        projection += p;
        rest -= rest * p;
    }
    return diagonalTangents(pattern.sideCount, 2 * piece * projection);
}

/// At a crease: along it, and across it. Both turned to lie on either side of the cap's middle, so that they are never
/// parallel, not even where the two sides of a lone face continue each other.
MatrixXd creaseTangents(const CapPattern& pattern, const MatrixXd& deflated, const MatrixXd& deepest) {
    const int n = pattern.faceCount, regularCount = pattern.sideCount == 4 ? 2 : 3;
    const Eigen::Index count = deflated.rows();
    const RowVectorXd along = 0.5 * (RowVectorXd::Unit(count, 1) - RowVectorXd::Unit(count, 1 + n));
    RowVectorXd across;
    if (n == 1) {
        // The matrix may have no second eigenvector. What is left of both tangents where the first ones cancel.
        across = std::ldexp(1.0, int(kCapLevels)) * deepest.colwise().sum();
    } else {
        // How far the middle edge moves by the eigenvector that is across.
        MatrixXd rest = deflated;
        if (n < regularCount) rest -= deflated * dominantProjection(deflated);
        across = dominantProjection(rest).row(1 + n / 2);
    }
    const double middle = std::numbers::pi * (pattern.face + 0.5) / n;
    MatrixXd rows(2, count);
    for (int i = 0; i < 2; ++i) {
        const double angle = middle + std::numbers::pi * (i == 0 ? -0.25 : 0.25);
        rows.row(i) = std::cos(angle) * along + std::sin(angle) * across;
    }
    return rows;
}

RowVectorXd stationaryRow(MatrixXd a) {
    for (int i = 0; i < kSquarings; ++i) {
        a = (a * a).eval();
        const Eigen::VectorXd sums = a.rowwise().sum(); // 1 but for rounding, which would grow
        a.array().colwise() /= sums.array();
    }
    return a.row(0) / a.row(0).sum();
}

} // namespace

int CapPattern::pointCount() const {
    return 1 + spokeCount() + (sideCount == 4 ? faceCount : 0) + int(capOuterPoints(*this).size());
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

CapMatrices::CapMatrices(const CapPattern& pattern, int levelCount) : pattern_(pattern) {
    const CapRefinement refinement(pattern);
    const MatrixXd a = refinement.matrix();
    limit_ = stationaryRow(a);
    const MatrixXd deflated = a - Eigen::VectorXd::Ones(a.rows()) * limit_;

    // Each level from the one before, twice as large.
    std::array<MatrixXd, kCapPieces> pieces;
    for (int piece = 0; piece < int(kCapPieces); ++piece) {
        const MatrixXd s = refinement.piece(piece);
        pieces[piece] = s;
        MatrixXd weights = 2 * (s - Eigen::VectorXd::Ones(s.rows()) * limit_);
        for (int level = 1; level <= std::max(levelCount, int(kCapLevels)); ++level) {
            if (level > 1) weights = (2 * weights * deflated).eval();
            if (piece == 0) levels_.emplace_back();
            levels_[level - 1][piece] = weights;
        }
    }
    const MatrixXd deepest = diagonalTangents(pattern.sideCount, levels_[kCapLevels - 1][1]);
    if (pattern.rule == VertexRule::corner)
        tangents_ = deepest;
    else if (pattern.rule == VertexRule::crease)
        tangents_ = creaseTangents(pattern, deflated, deepest);
    else
        tangents_ = smoothTangents(pattern, deflated, pieces[1]);
    levels_.resize(levelCount);
}

CapPlace placeInCap(int sideCount, double a, double b, int levelCount) {
    const double distance = sideCount == 4 ? std::max(a, b) : a + b;
    CapPlace place;
    if (!(distance > 0)) return place;
    const int level = std::max(-std::ilogb(distance), 1);
    place.level = std::min(level, levelCount);
    place.size = std::ldexp(1.0, -level);
    const double x = std::ldexp(a, level), y = std::ldexp(b, level);
    if (sideCount == 4) {
        place.piece = x < 1 ? 2 : y < 1 ? 0 : 1;
        place.u = x - (place.piece == 2 ? 0 : 1), place.v = y - (place.piece == 0 ? 0 : 1);
    } else {
        place.piece = x >= 1 ? 0 : y >= 1 ? 2 : 1;
        place.u = place.piece == 0 ? x - 1 : x, place.v = place.piece == 2 ? y - 1 : y;
        if (place.piece == 1) place.u = 1 - x, place.v = 1 - y, place.slope = -1;
    }
    return place;
}

namespace {

std::array<Jet, 4> cubicSpline(const Jet& t) {
    const Jet s = Jet{1} - t;
    const Jet t2 = t * t, t3 = t2 * t, s2 = s * s, s3 = s2 * s;
    return {(1.0 / 6) * s3, (1.0 / 6) * (3 * t3 - 6 * t2 + Jet{4}), (1.0 / 6) * (3 * s3 - 6 * s2 + Jet{4}),
            (1.0 / 6) * t3};
}

/// Stam, Evaluation of Loop Subdivision Surfaces (1998), appendix A: the quartic box spline by barycentric coordinates
/// u, v, w of the triangle; here for the corner (0,0) where u = 1 and the numbers of kBoxPoints.
std::vector<Jet> boxSpline(const Jet& v, const Jet& w) {
    const Jet u = Jet{1} - v - w;
    const Jet u3 = u * u * u, v3 = v * v * v, w3 = w * w * w;
    const Jet u4 = u3 * u, v4 = v3 * v, w4 = w3 * w;
    // The central weight of a corner where x = 1, with y and z the other two.
    const auto own = [](const Jet& x, const Jet& y, const Jet& z) {
        const Jet x2 = x * x, y2 = y * y, z2 = z * z;
        return 6 * x2 * x2 + 24 * x2 * x * z + 24 * x2 * z2 + 8 * x * z2 * z + z2 * z2 + 24 * x2 * x * y +
               60 * x2 * y * z + 36 * x * y * z2 + 6 * y * z2 * z + 24 * x2 * y2 + 36 * x * y2 * z + 12 * y2 * z2 +
               8 * x * y2 * y + 6 * y2 * y * z + y2 * y2;
    };
    // A point beside two corners, x near and y: it lies across the edge from x to y.
    const auto across = [](const Jet& x, const Jet& y, const Jet& z) {
        const Jet x2 = x * x, y2 = y * y;
        return x2 * x2 + 6 * x2 * x * y + 12 * x2 * y2 + 6 * x * y2 * y + y2 * y2 + 2 * x2 * x * z + 6 * x2 * y * z +
               6 * x * y2 * z + 2 * y2 * y * z;
    };
    std::vector<Jet> b(12);
    b[0] = u4 + 2 * u3 * v;
    b[1] = across(u, v, w);
    b[2] = v4 + 2 * u * v3;
    b[3] = u4 + 2 * u3 * w;
    b[4] = own(u, v, w);
    b[5] = own(v, w, u);
    b[6] = v4 + 2 * v3 * w;
    b[7] = across(u, w, v);
    b[8] = own(w, u, v);
    b[9] = across(v, w, u);
    b[10] = w4 + 2 * u * w3;
    b[11] = w4 + 2 * v * w3;
    for (Jet& jet : b) jet = (1.0 / 12) * jet;
    return b;
}

} // namespace

std::vector<Jet> pieceBasis(int sideCount, double u, double v) {
    const Jet s{u, 1, 0}, t{v, 0, 1};
    if (sideCount == 3) return boxSpline(s, t);
    std::vector<Jet> basis;
    const auto along = cubicSpline(s), across = cubicSpline(t);
    for (const Jet& y : across)
        for (const Jet& x : along) basis.push_back(x * y);
    return basis;
}

} // namespace relief

// The whole ring of a vertex: what of it counts in the end caps of vertices of many faces, and directions at the
// vertex.
#include <cmath>
#include <numbers>

#include "base/checks.h"
#include "surface/caps.h"

namespace relief {
namespace {

using Eigen::MatrixXd;
using Eigen::RowVectorXd;

constexpr double kPi = std::numbers::pi;

/// Points of a ring: 0 is the vertex, then the other ends of the edges, then the far corners.
int ringCount(const CapPattern& pattern) {
    return 1 + pattern.spokeCount() + (pattern.sideCount == 4 ? pattern.faceCount : 0);
}

/// The left eigenvector of a wave, which weighs the ends of the edges by wave(j): far corners have
/// (wave(j) + wave(j + 1)) / (16 L - 4), L the eigenvalue. The vertex and sharp edges are the caller's.
template <typename Wave>
RowVectorXd waveWeights(const CapPattern& pattern, double eigenvalue, const Wave& wave) {
    RowVectorXd weights = RowVectorXd::Zero(ringCount(pattern));
    for (int j = 0; j < pattern.spokeCount(); ++j) weights(1 + j) = wave(j);
    if (pattern.sideCount == 4)
        for (int j = 0; j < pattern.faceCount; ++j)
            weights(1 + pattern.spokeCount() + j) = (wave(j) + wave(j + 1)) / (16 * eigenvalue - 4);
    return weights;
}

/// The angle of tangent `i`, 0 or 1, in radians from edge 0 around the vertex, where each face takes `faceAngle`. The
/// two lie 45 degrees before and behind the middle of the cap: they are nearly perpendicular however thin the face is.
double angleOf(const CapPattern& pattern, double faceAngle, int i) {
    return faceAngle * (pattern.face + 0.5) + kPi * (i == 0 ? -0.25 : 0.25);
}

MatrixXd smoothTangents(const CapPattern& pattern) {
    const int n = pattern.faceCount;
    const double angle = 2 * kPi / n, eigenvalue = waveEigenvalue(pattern.sideCount, angle);
    MatrixXd rows(2, ringCount(pattern));
    for (int i = 0; i < 2; ++i)
        rows.row(i) = 2.0 / n * waveWeights(pattern, eigenvalue, [&](int j) {
                          return std::cos(angle * j - angleOf(pattern, angle, i));
                      });
    return rows;
}

/// Along the needle all edges move alike; around it they turn about the cap's middle.
MatrixXd needleTangents(const CapPattern& pattern) {
    const int n = pattern.faceCount;
    const double angle = 2 * kPi / n;
    RowVectorXd along = waveWeights(pattern, waveEigenvalue(pattern.sideCount, 0), [](int) { return 1; });
    along(0) = -along.sum();
    const RowVectorXd around = waveWeights(pattern, waveEigenvalue(pattern.sideCount, angle),
                                           [&](int j) { return std::sin(angle * (j - pattern.face - 0.5)); });
    MatrixXd rows(2, along.size());
    rows << 0.5 / n * (along - 2 * around), 0.5 / n * (along + 2 * around);
    return rows;
}

/// Across a crease the wave of half a turn, in which neither the vertex nor the sharp edges move; but it depends on
/// them.
RowVectorXd acrossCrease(const CapPattern& pattern) {
    const int n = pattern.faceCount;
    const bool isQuad = pattern.sideCount == 4;
    const double angle = kPi / n, eigenvalue = waveEigenvalue(pattern.sideCount, angle);
    const auto wave = [&](int j) { return std::sin(angle * j); };
    RowVectorXd across = waveWeights(pattern, eigenvalue, wave);
    across(1) = across(1 + n) = 0; // the wave ends there, but for rounding
    // What depends on a sharp edge's end e: L x_e = x_e / 2 + x_vertex / 8 + what its neighbours have of it, where
    // x_vertex = -(the rest + 2 x_e), as the weights sum up to 0.
    const double beside = isQuad ? across(2) / 16 + across(2 + n) / 4 : across(2) / 8;
    const double end = (beside - across.sum() / 8) / (eigenvalue - 0.25);
    across(1) = across(1 + n) = end;
    across(0) = -across.sum();
    // As far as the wave moves the middle edge: the other factor of the projection is the wave itself.
    double product = 0;
    for (int j = 0; j < n; ++j) {
        product += across(1 + j) * wave(j);
        if (isQuad) product += across(2 + n + j) * (wave(j) + wave(j + 1)) / (4 * eigenvalue - 1);
    }
    return across / product;
}

MatrixXd creaseTangents(const CapPattern& pattern) {
    const int n = pattern.faceCount, count = ringCount(pattern);
    const RowVectorXd along = 0.5 * (RowVectorXd::Unit(count, 1) - RowVectorXd::Unit(count, 1 + n));
    const RowVectorXd across = acrossCrease(pattern);
    MatrixXd rows(2, count);
    for (int i = 0; i < 2; ++i) {
        const double angle = angleOf(pattern, kPi / n, i);
        rows.row(i) = std::cos(angle) * along + std::sin(angle) * across;
    }
    return rows;
}

/// The rules of all of the ring, which depend on no other points.
MatrixXd ringMatrix(CapPattern pattern) {
    const int count = ringCount(pattern);
    pattern.window = 0;
    return refinementAround(pattern).topLeftCorner(count, count);
}

/// The rows of p0 + 2^n (v_n - p0) for n = 1, 2, ..., v_n the vertex after n refinements. `limit`: ringLimit().
MatrixXd dartMeans(const CapPattern& pattern, const RowVectorXd& limit) {
    const MatrixXd ring = ringMatrix(pattern);
    RowVectorXd away = RowVectorXd::Unit(ring.cols(), 0) - limit;
    MatrixXd rows(pattern.meanCount(), ring.cols());
    for (int i = 0; i < rows.rows(); ++i) {
        away = (2 * away * ring).eval();
        away -= away.sum() * limit; // the sum is 0 but for rounding, which would grow
        rows.row(i) = limit + away;
    }
    return rows;
}

} // namespace

double waveEigenvalue(int sideCount, double angle) {
    const double c = std::cos(angle);
    if (sideCount == 3) return 0.375 + 0.25 * c;
    return (5 + c + std::cos(angle / 2) * std::sqrt(18 + 2 * c)) / 16;
}

int CapPattern::meanCount() const {
    if (window == 0 || rule == VertexRule::corner) return 0;
    if (rule == VertexRule::crease) return 1;
    if (hasDart) return window - 1; // the levels that the window is for
    return sideCount == 4 ? 2 : 1;
}

int CapPattern::tangentCount() const {
    if (window == 0 || hasDart) return 0;
    return rule == VertexRule::corner && !isClosed ? 0 : 2;
}

int CapPattern::pointCount() const {
    return 1 + windowSpokeCount() + (sideCount == 4 ? windowFaceCount() : 0) + int(capOuterPoints(*this).size()) +
           sumCount();
}

CapPattern CapPattern::ofWindow() const {
    CapPattern pattern = *this;
    if (window == 0 || (isClosed && !hasDart)) return pattern;
    // A sharp edge beyond the window is as good as one just beyond it.
    pattern.face = std::min(face, window + 1);
    pattern.faceCount = pattern.face + 1 + std::min(faceCount - 1 - face, window + 1);
    return pattern;
}

RowVectorXd ringLimit(const CapPattern& pattern) {
    const int n = pattern.faceCount;
    RowVectorXd limit = RowVectorXd::Zero(ringCount(pattern));
    if (pattern.isDart()) return stationaryRow(ringMatrix(pattern));
    if (pattern.rule == VertexRule::corner) {
        limit(0) = 1;
    } else if (pattern.rule == VertexRule::crease) {
        limit(0) = 2.0 / 3;
        limit(1) = limit(1 + n) = 1.0 / 6;
    } else if (pattern.sideCount == 4) {
        // Catmull and Clark's n^2, 4 and 1 (Halstead, Kass and DeRose 1993).
        limit(0) = n / (n + 5.0);
        limit.segment(1, n).setConstant(4 / (n * (n + 5.0)));
        limit.tail(n).setConstant(1 / (n * (n + 5.0)));
    } else {
        const double middle = 0.375 + 0.25 * std::cos(2 * kPi / n), beta = (0.625 - middle * middle) / n;
        limit(0) = 1 / (1 + 8 * beta * n / 3);
        limit.tail(n).setConstant((1 - limit(0)) / n);
    }
    return limit;
}

MatrixXd ringMeans(const CapPattern& pattern, const RowVectorXd& limit) {
    if (pattern.isDart()) return dartMeans(pattern, limit);
    const int n = pattern.faceCount;
    MatrixXd rows = MatrixXd::Zero(pattern.meanCount(), ringCount(pattern));
    if (pattern.rule == VertexRule::crease)
        rows(0, 1) = rows(0, 1 + n) = 0.5;
    else if (pattern.rule == VertexRule::smooth)
        for (int i = 0; i < pattern.meanCount(); ++i) rows.row(i).segment(1 + i * n, n).setConstant(1.0 / n);
    return rows;
}

MatrixXd ringTangents(const CapPattern& pattern) {
    RELIEF_CHECK(!pattern.hasDart);
    switch (pattern.rule) {
    case VertexRule::smooth: return smoothTangents(pattern);
    case VertexRule::crease: return creaseTangents(pattern);
    default: return needleTangents(pattern);
    }
}

} // namespace relief

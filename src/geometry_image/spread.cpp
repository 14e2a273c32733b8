#include "geometry_image/spread.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Sparse>

namespace relief {
namespace {

/// What a triangle adds: twice its area on the surface, twice that in the plane, and the sum of the squares of both
/// singular values of the map.
struct TriangleStretch {
    double area = 0, planeArea = 0, squares = 0;
};

constexpr double kMostSquares = 1e24; ///< of triangles that the plane has no area for

TriangleStretch measureTriangle(const CutMesh& mesh, const Disk& disk, std::span<const dvec2> st, std::uint32_t h) {
    const dvec3 &q1 = mesh.positions[mesh.corners[h]], q2 = mesh.positions[mesh.corners[h + 1]],
                q3 = mesh.positions[mesh.corners[h + 2]];
    const dvec2 &p1 = st[disk.corners[h]], p2 = st[disk.corners[h + 1]], p3 = st[disk.corners[h + 2]];
    const dvec2 a = p2 - p1, b = p3 - p1;
    TriangleStretch result{.area = glm::length(glm::cross(q2 - q1, q3 - q1)), .planeArea = a.x * b.y - a.y * b.x};
    if (!(result.planeArea > 0)) {
        result.squares = kMostSquares;
        return result;
    }
    // S_s and S_t of Sander et al. 2001, relative to the first corner.
    const dvec3 ss = ((q2 - q1) * b.y - (q3 - q1) * a.y) / result.planeArea;
    const dvec3 st2 = ((q3 - q1) * a.x - (q2 - q1) * b.x) / result.planeArea;
    result.squares = std::min(kMostSquares, glm::dot(ss, ss) + glm::dot(st2, st2));
    return result;
}

/// Adds up what both half-edges of an edge have.
void joinHalves(const CutMesh& mesh, std::vector<double>& values) {
    for (std::uint32_t h = 0; h < mesh.halfEdgeCount(); ++h)
        if (const std::uint32_t twin = mesh.twins[h]; twin != kNone && h < twin)
            values[h] = values[twin] = values[h] + values[twin];
}

/// Cotangents of the angles opposite to each edge, which reproduce what is flat (Pinkall and Polthier 1993); empty
/// where one of the sums is negative.
std::vector<double> computeCotangents(const CutMesh& mesh) {
    std::vector<double> weights(mesh.halfEdgeCount(), 0);
    for (std::uint32_t h = 0; h < mesh.halfEdgeCount(); ++h) {
        const dvec3 a = mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)];
        const dvec3 b = mesh.positions[mesh.from(previousOf(h))] - mesh.positions[mesh.from(h)];
        const double sine = glm::length(glm::cross(a, b));
        if (!(sine > 1e-3 * glm::length(a) * glm::length(b))) return {};
        weights[nextOf(h)] = glm::dot(a, b) / sine;
    }
    joinHalves(mesh, weights);
    constexpr double kRounding = 1e-6;
    for (std::uint32_t h = 0; h < mesh.halfEdgeCount(); ++h)
        if (mesh.twins[h] != kNone && weights[h] < -kRounding) return {};
    for (double& weight : weights) weight = std::max(weight, 0.0);
    return weights;
}

/// Mean value weights of both ends of each edge, added up.
std::vector<double> computeMeanValues(const CutMesh& mesh) {
    double sum = 0;
    for (std::uint32_t h = 0; h < mesh.halfEdgeCount(); ++h) sum += mesh.length(h);
    const double shortest = 1e-6 * sum / double(mesh.halfEdgeCount());
    std::vector<double> weights(mesh.halfEdgeCount(), 0);
    for (std::uint32_t h = 0; h < mesh.halfEdgeCount(); ++h) {
        const std::uint32_t before = previousOf(h);
        const dvec3 a = mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)];
        const dvec3 b = mesh.positions[mesh.from(before)] - mesh.positions[mesh.from(h)];
        const double la = std::max(shortest, glm::length(a)), lb = std::max(shortest, glm::length(b));
        // tan(angle / 2) = sin / (1 + cos), within what thin triangles and flat angles may ask for.
        const double cosine = glm::dot(a, b) / (la * lb), sine = glm::length(glm::cross(a, b)) / (la * lb);
        const double half = std::clamp(sine / std::max(1e-9, 1 + cosine), 1e-5, 1e5);
        weights[h] += half / la;
        weights[before] += half / lb;
    }
    joinHalves(mesh, weights);
    return weights;
}

std::vector<double> computeWeights(const CutMesh& mesh) {
    std::vector<double> cotangents = computeCotangents(mesh);
    return cotangents.empty() ? computeMeanValues(mesh) : cotangents;
}

/// The equations of the copies inside: sum over j of w_ij (p_j - p_i) = 0.
class InnerSystem {
public:
    InnerSystem(const CutMesh& mesh, const Disk& disk)
        : mesh_(mesh), disk_(disk), weights_(computeWeights(mesh)), numbers_(disk.vertexCount(), kNone) {
        for (std::uint32_t v = 0; v < disk.vertexCount(); ++v)
            if (disk.isOnBorder[v] == 0) numbers_[v] = count_++;
    }

    /// Moves the inner copies. `divisors`: per copy, what the weights at it are divided by.
    void solve(std::vector<dvec2>& st, std::span<const double> divisors) {
        if (count_ == 0) return;
        // Neighbours inside are unknowns, those on the border go to the right side.
        std::vector<Eigen::Triplet<double>> entries;
        entries.reserve(mesh_.halfEdgeCount() + count_);
        Eigen::MatrixXd right = Eigen::MatrixXd::Zero(count_, 2);
        std::vector<double> diagonal(count_, 0);
        for (std::uint32_t h = 0; h < mesh_.halfEdgeCount(); ++h) {
            const std::uint32_t from = disk_.corners[h], to = disk_.corners[nextOf(h)], i = numbers_[from];
            if (i == kNone) continue;
            const double weight = weights_[h] / (divisors[from] * divisors[to]);
            diagonal[i] += weight;
            const std::uint32_t j = numbers_[to];
            if (j == kNone)
                right(i, 0) += weight * st[to].x, right(i, 1) += weight * st[to].y;
            else if (j < i) // the lower half is read
                entries.emplace_back(i, j, -weight);
        }
        for (std::uint32_t i = 0; i < count_; ++i) entries.emplace_back(i, i, diagonal[i]);
        // The pattern of the matrix is that of the mesh: it is analysed once.
        Eigen::SparseMatrix<double> matrix(count_, count_);
        matrix.setFromTriplets(entries.begin(), entries.end());
        if (!isAnalysed_) solver_.analyzePattern(matrix);
        isAnalysed_ = true;
        solver_.factorize(matrix);
        RELIEF_CHECK(solver_.info() == Eigen::Success);
        const Eigen::MatrixXd found = solver_.solve(right);
        for (std::uint32_t v = 0; v < disk_.vertexCount(); ++v)
            if (numbers_[v] != kNone) st[v] = {found(numbers_[v], 0), found(numbers_[v], 1)};
    }

private:
    const CutMesh& mesh_;
    const Disk& disk_;
    std::vector<double> weights_;
    std::vector<std::uint32_t> numbers_; ///< per copy: its unknown
    std::uint32_t count_ = 0;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> solver_;
    bool isAnalysed_ = false;
};

} // namespace

Stretch measureStretch(const CutMesh& mesh, const Disk& disk, std::span<const dvec2> st) {
    Stretch stretch{0, std::vector<double>(disk.vertexCount(), 0)};
    std::vector<double> areas(disk.vertexCount(), 0);
    double area = 0, planeArea = 0, sum = 0;
    for (std::uint32_t h = 0; h < mesh.halfEdgeCount(); h += 3) {
        const TriangleStretch one = measureTriangle(mesh, disk, st, h);
        area += one.area, planeArea += std::max(0.0, one.planeArea), sum += one.area * one.squares / 2;
        for (std::uint32_t k = 0; k < 3; ++k) {
            stretch.perVertex[disk.corners[h + k]] += one.area * one.squares / 2;
            areas[disk.corners[h + k]] += one.area;
        }
    }
    // A map of even scale has the stretch sqrt(area / planeArea) everywhere.
    const double scale = planeArea / area;
    stretch.total = std::sqrt(sum / area * scale);
    for (std::uint32_t v = 0; v < disk.vertexCount(); ++v)
        stretch.perVertex[v] = areas[v] > 0 ? std::sqrt(stretch.perVertex[v] / areas[v] * scale) : 1;
    return stretch;
}

std::vector<dvec2> placeOnCircle(const CutMesh& mesh, const Disk& disk, std::span<const BorderPath> border) {
    double length = 0, at = 0;
    for (const BorderPath& path : border) length += path.length;
    std::vector<dvec2> st(disk.vertexCount(), dvec2(0));
    for (const BorderPath& path : border)
        for (const std::uint32_t h : path.halfEdges) {
            const double angle = 2 * std::numbers::pi * at / length;
            st[disk.corners[h]] = {std::cos(angle), std::sin(angle)};
            at += mesh.length(h);
        }
    return st;
}

SpreadMap spreadInside(const CutMesh& mesh, const Disk& disk, std::vector<dvec2> border, int steps) {
    InnerSystem system(mesh, disk);
    std::vector<double> divisors(disk.vertexCount(), 1);
    SpreadMap best{.st = std::move(border)};
    system.solve(best.st, divisors);
    Stretch stretch = measureStretch(mesh, disk, best.st);
    best.stretch = best.firstStretch = stretch.total;
    // Steps that make the stretch larger are taken back and made half as long.
    constexpr double kShortest = 0.05, kLeastGain = 2e-3;
    double power = 1;
    for (int step = 0; step < steps && power > kShortest; ++step) {
        std::vector<double> tried(divisors);
        for (std::uint32_t v = 0; v < disk.vertexCount(); ++v) // within a range that leaves the equations solvable
            tried[v] = std::clamp(tried[v] * std::pow(std::clamp(stretch.perVertex[v], 1e-3, 1e3), power), 1e-6, 1e6);
        std::vector<dvec2> st = best.st;
        system.solve(st, tried);
        Stretch found = measureStretch(mesh, disk, st);
        if (found.total > (1 - kLeastGain) * best.stretch) power /= 2;
        if (found.total >= best.stretch) continue;
        best.st = std::move(st), best.stretch = found.total;
        stretch = std::move(found), divisors = std::move(tried);
    }
    return best;
}

} // namespace relief

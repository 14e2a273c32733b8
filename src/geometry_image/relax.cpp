// Moving the points inside of a spread disk, all of them at once, to where triangles are stretched and sheared least.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Sparse>

#include "geometry_image/spread.h"

namespace relief {
namespace {

constexpr double kShearWeight = 4; ///< what rows and columns that are not perpendicular cost, beside the stretch

/// A triangle of the disk. With u = p2 - p1 and v = p3 - p1 in the plane, Q1 and Q2 the same on the surface and
/// D = u x v, the surface runs along s and t by S_s = (Q1 v.y - Q2 u.y) / D and S_t = (Q2 u.x - Q1 v.x) / D.
struct RelaxedTriangle {
    std::array<std::uint32_t, 3> copies{};
    double q1q1 = 0, q2q2 = 0, q1q2 = 0; ///< dot products
    double area = 0;                     ///< of the surface
};

/// The energy of a triangle and its derivatives with respect to u and v.
struct TriangleEnergy {
    double energy = std::numeric_limits<double>::infinity(); ///< where the triangle is turned over
    double planeArea = 0;                                    ///< twice, as D
    dvec2 du{0}, dv{0};
};

/// area * (|S_s|^2 + |S_t|^2 + kShearWeight |S_s| |S_t|). The first two terms are the L2 stretch of Sander et al. 2001.
/// In the third, |S_s| |S_t| = |S_s x S_t| / sin(angle between them): where triangles are stretched along one direction
/// more than across it, as on long arms, rows of samples that run along neither make needles, whose normals are any
/// (Schwarz's lantern).
TriangleEnergy energyOf(const RelaxedTriangle& t, const dvec2& u, const dvec2& v) {
    TriangleEnergy result{.planeArea = u.x * v.y - u.y * v.x};
    const double d = result.planeArea;
    if (!(d > 0)) return result;
    // |S_s|^2 and |S_t|^2 times d^2: differences, which rounding may bring to 0 and below.
    const auto along = [&](double x, double y) {
        constexpr double kRounding = 1e-12, kLeast = 1e-100;
        const double terms = y * y * t.q1q1 + x * x * t.q2q2;
        return std::max(terms - 2 * x * y * t.q1q2, std::max(kRounding * terms, kLeast));
    };
    const double alongS = along(u.y, v.y), alongT = along(u.x, v.x);
    const double product = std::sqrt(alongS * alongT), sum = alongS + alongT + kShearWeight * product;
    const double byS = 1 + kShearWeight * alongT / (2 * product), byT = 1 + kShearWeight * alongS / (2 * product);
    const double scale = t.area / (d * d), byD = -2 * scale * sum / d;
    result.energy = scale * sum;
    result.du = 2 * scale * dvec2(byT * (u.x * t.q2q2 - v.x * t.q1q2), byS * (u.y * t.q2q2 - v.y * t.q1q2)) +
                byD * dvec2(v.y, -v.x);
    result.dv = 2 * scale * dvec2(byT * (v.x * t.q1q1 - u.x * t.q1q2), byS * (v.y * t.q1q1 - u.y * t.q1q2)) +
                byD * dvec2(-u.y, u.x);
    return result;
}

using Points = std::vector<dvec2>;

class Relaxation {
public:
    Relaxation(const CutMesh& mesh, const Disk& disk, Points& st)
        : st_(st), numbers_(disk.vertexCount(), kNone), gradient_(st.size()), step_(st.size(), dvec2(0)) {
        for (std::uint32_t v = 0; v < disk.vertexCount(); ++v)
            if (disk.isOnBorder[v] == 0) numbers_[v] = count_++;
        listTriangles(mesh, disk);
        energy_ = evaluate(st_, &gradient_);
    }

    /// One step downhill; false where it gains nothing that counts.
    bool descend() {
        if (count_ == 0 || !solveStep()) return false;
        double slope = 0;
        for (std::size_t v = 0; v < st_.size(); ++v)
            if (numbers_[v] != kNone) slope += glm::dot(step_[v], gradient_[v]);
        // As far as no triangle turns over, then half as far until the energy falls as it should, and while it falls.
        constexpr int kHalvings = 30;
        constexpr double kFarthest = 2, kShareOfSlope = 1e-4, kLeastGain = 1e-3;
        double length = std::min(kFarthest, 0.9 * findTurning());
        Points moved = at(length);
        double energy = evaluate(moved, nullptr);
        for (int i = 0; !(energy < energy_ + kShareOfSlope * length * slope); ++i) {
            if (i == kHalvings) return false;
            length /= 2, moved = at(length), energy = evaluate(moved, nullptr);
        }
        for (int i = 0; i < kHalvings; ++i) {
            Points nearer = at(length / 2);
            const double found = evaluate(nearer, nullptr);
            if (!(found < energy)) break;
            length /= 2, moved = std::move(nearer), energy = found;
        }
        const double gain = (energy_ - energy) / energy_;
        st_ = std::move(moved);
        energy_ = evaluate(st_, &gradient_);
        return gain > kLeastGain;
    }

private:
    /// All but those that are turned over already, which have no energy that could be made smaller.
    void listTriangles(const CutMesh& mesh, const Disk& disk) {
        double area = 0;
        for (std::uint32_t h = 0; h < disk.corners.size(); h += 3) {
            const dvec3& q = mesh.positions[mesh.corners[h]];
            const dvec3 q1 = mesh.positions[mesh.corners[h + 1]] - q, q2 = mesh.positions[mesh.corners[h + 2]] - q;
            const RelaxedTriangle triangle{.copies = {disk.corners[h], disk.corners[h + 1], disk.corners[h + 2]},
                                           .q1q1 = glm::dot(q1, q1),
                                           .q2q2 = glm::dot(q2, q2),
                                           .q1q2 = glm::dot(q1, q2),
                                           .area = glm::length(glm::cross(q1, q2)) / 2};
            area += triangle.area;
            const auto [u, v] = sidesOf(triangle, st_);
            if (energyOf(triangle, u, v).planeArea > 0) triangles_.push_back(triangle);
        }
        // Those without an area must not turn over either.
        const double least = 1e-6 * area / double(std::max<std::size_t>(1, triangles_.size()));
        for (RelaxedTriangle& triangle : triangles_) triangle.area = std::max(triangle.area, least);
    }

    static std::pair<dvec2, dvec2> sidesOf(const RelaxedTriangle& t, const Points& points) {
        return {points[t.copies[1]] - points[t.copies[0]], points[t.copies[2]] - points[t.copies[0]]};
    }

    double evaluate(const Points& points, Points* gradient) const {
        double sum = 0;
        if (gradient != nullptr) std::ranges::fill(*gradient, dvec2(0));
        for (const RelaxedTriangle& triangle : triangles_) {
            const auto [u, v] = sidesOf(triangle, points);
            const TriangleEnergy one = energyOf(triangle, u, v);
            sum += one.energy;
            if (gradient == nullptr) continue;
            (*gradient)[triangle.copies[0]] -= one.du + one.dv;
            (*gradient)[triangle.copies[1]] += one.du;
            (*gradient)[triangle.copies[2]] += one.dv;
        }
        return sum;
    }

    /// The step x of H x = -gradient. H takes the place of the second derivatives: a triangle that is deformed by grad
    /// x has about 6 |grad x|^2 of its energy more, because that goes with the inverse square of lengths in the plane.
    /// That is Dirichlet's integral, whose matrix has the cotangents of its angles (Pinkall and Polthier 1993).
    bool solveStep() {
        std::vector<Eigen::Triplet<double>> entries;
        entries.reserve(3 * triangles_.size() + count_);
        std::vector<double> diagonal(count_, 0);
        for (const RelaxedTriangle& triangle : triangles_) {
            const auto [u, v] = sidesOf(triangle, st_);
            const TriangleEnergy one = energyOf(triangle, u, v);
            const double density = 6 * one.energy / (one.planeArea * one.planeArea);
            const std::array<dvec2, 3> sides{v - u, -v, u}; // side k is opposite to corner k
            for (std::size_t k = 0; k < 3; ++k) {
                const double weight = -density * glm::dot(sides[(k + 1) % 3], sides[(k + 2) % 3]);
                const std::uint32_t i = numbers_[triangle.copies[(k + 1) % 3]],
                                    j = numbers_[triangle.copies[(k + 2) % 3]];
                if (i != kNone) diagonal[i] += weight;
                if (j != kNone) diagonal[j] += weight;
                if (i != kNone && j != kNone) entries.emplace_back(std::max(i, j), std::min(i, j), -weight);
            }
        }
        constexpr double kSlack = 1e-9;
        for (std::uint32_t i = 0; i < count_; ++i) entries.emplace_back(i, i, diagonal[i] * (1 + kSlack));
        Eigen::SparseMatrix<double> matrix(count_, count_);
        matrix.setFromTriplets(entries.begin(), entries.end());
        if (!isAnalysed_) solver_.analyzePattern(matrix); // the pattern is that of the mesh
        isAnalysed_ = true;
        solver_.factorize(matrix);
        if (solver_.info() != Eigen::Success) return false;
        Eigen::MatrixXd right(count_, 2);
        for (std::size_t v = 0; v < st_.size(); ++v)
            if (numbers_[v] != kNone) right.row(numbers_[v]) << -gradient_[v].x, -gradient_[v].y;
        const Eigen::MatrixXd found = solver_.solve(right);
        if (!found.allFinite()) return false;
        for (std::size_t v = 0; v < st_.size(); ++v)
            if (numbers_[v] != kNone) step_[v] = {found(numbers_[v], 0), found(numbers_[v], 1)};
        return true;
    }

    /// The length of the step at which the first triangle turns over: the smallest root above 0 of its area, which is a
    /// quadratic function of the length (Smith and Schaefer 2015, section 3.3).
    [[nodiscard]] double findTurning() const {
        double least = std::numeric_limits<double>::infinity();
        const auto cross = [](const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; };
        for (const RelaxedTriangle& triangle : triangles_) {
            const auto [u, v] = sidesOf(triangle, st_);
            const auto [du, dv] = sidesOf(triangle, step_);
            const double a = cross(du, dv), b = cross(u, dv) + cross(du, v), c = cross(u, v);
            const double discriminant = b * b - 4 * a * c;
            if (discriminant < 0) continue;
            const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
            for (const double root : {q / a, c / q}) // without a root it is not finite, or not above 0
                if (root > 0) least = std::min(least, root);
        }
        return least;
    }

    [[nodiscard]] Points at(double length) const {
        Points points(st_);
        for (std::size_t v = 0; v < points.size(); ++v) points[v] += length * step_[v];
        return points;
    }

    Points& st_;
    std::vector<RelaxedTriangle> triangles_;
    std::vector<std::uint32_t> numbers_; ///< per copy: its unknown
    std::uint32_t count_ = 0;
    Points gradient_, step_;
    double energy_ = 0;
    Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> solver_;
    bool isAnalysed_ = false;
};

} // namespace

void relaxInside(const CutMesh& mesh, const Disk& disk, std::vector<dvec2>& st, int steps) {
    Relaxation relaxation(mesh, disk, st);
    for (int step = 0; step < steps && relaxation.descend();) ++step;
}

} // namespace relief

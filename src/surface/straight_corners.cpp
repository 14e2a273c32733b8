// Corners whose tangents span no plane: found by the weights of the tangents, whatever the cage's
// positions.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "surface/gregory.h"
#include "surface/rows.h"

namespace relief {
namespace {

/// Compares rows as vectors of weights, as seen from a third row.
class RowAngles {
public:
    explicit RowAngles(std::size_t namedCount) : sums_(namedCount) {}

    struct Angle {
        double length, cosine; ///< of the longer of a - origin and b - origin; between the two
    };
    Angle measure(const RowTable& rows, std::size_t origin, std::size_t a, std::size_t b) {
        add(rows.row(origin), {-1, -1});
        add(rows.row(a), {1, 0});
        add(rows.row(b), {0, 1});
        double aa = 0, ab = 0, bb = 0;
        for (const std::uint32_t i : used_) {
            const dvec2 sum = sums_[i]; // 0 at the second visit of a point
            aa += sum.x * sum.x, ab += sum.x * sum.y, bb += sum.y * sum.y;
            sums_[i] = dvec2(0);
        }
        used_.clear();
        return {std::sqrt(std::max(aa, bb)), aa * bb > 0 ? ab / std::sqrt(aa * bb) : 1};
    }

private:
    void add(std::span<const RowTable::Entry> row, const dvec2& weight) {
        for (const RowTable::Entry& entry : row) {
            sums_[entry.index] += entry.weight * weight;
            used_.push_back(entry.index);
        }
    }

    std::vector<dvec2> sums_; ///< per point that entries name: of a - origin and b - origin
    std::vector<std::uint32_t> used_;
};

/// OpenSubdiv's own tangents at straight corners are 1.5e-5 off parallel.
constexpr double kStraightCosine = -1 + 1e-7;
/// Weights of a tangent below this length count as 0, for a patch as large as the face; a patch of half the size has
/// half as much.
constexpr double kVanishingTangent = 1e-3, kNoTangent = 1e-5;

/// A face takes less than 6 degrees around a vertex of more than 60 faces: the cross product of its own tangents would
/// magnify their rounding tenfold and more.
constexpr double kNarrowCosine = 0.9945;

enum class CornerKind { plain, straight, vanishing, narrow };

/// Two points around a vertex whose directions from it are nearly perpendicular, the second counter-clockwise.
struct Axes {
    std::uint32_t first = 0, second = 0;
};

/// Of a corner of a face: its (u,v), and the directions along its two sides into the face, by (u,v).
struct CornerDirections {
    dvec2 uv, next, previous;
};

CornerDirections directionsAt(int sideCount, int corner) {
    const dvec2 uv = sidePoint(sideCount, corner, 0);
    const int before = (corner + sideCount - 1) % sideCount;
    return {uv, sidePoint(sideCount, corner, 1) - uv, sidePoint(sideCount, before, 0) - uv};
}

/// Other corners of a patch lie inside the face, where its tangents may be anything.
bool isFaceCorner(const Patch& patch, int sideCount, int corner) {
    const Far::PatchParam param{patch.param0, patch.param1};
    const dvec2 at(param.GetU(), param.GetV());
    const double last = std::ldexp(1.0, depthInFace(param)) - 1;
    if (sideCount == 3 && param.IsTriangleRotated()) return false;
    return at == last * sidePoint(sideCount, corner, 0);
}

class StraightCornerBuilder {
public:
    StraightCornerBuilder(Surface& surface, RowTable& rows)
        : surface_(surface), rows_(rows), angles_(rows.namedCount()) {}

    void build() {
        findAxes();
        std::vector<std::uint32_t> points;
        points.reserve(surface_.patchPoints.size());
        for (Patch& patch : surface_.patches) {
            const auto indices = std::span(surface_.patchPoints).subspan(patch.firstPoint, patch.pointCount);
            patch.firstPoint = std::uint32_t(points.size());
            points.insert(points.end(), indices.begin(), indices.end());
            if (patch.type != kPatchGregory && patch.type != kPatchGregoryTriangle) continue;
            for (int corner = 0; corner < surface_.sideCount; ++corner) {
                const CornerKind kind = kindOf(patch, indices, corner);
                if (kind == CornerKind::narrow)
                    addNarrowCorner(patch, corner, axes_.at(indices[5 * std::size_t(corner)]), points);
                else if (kind != CornerKind::plain)
                    addCorner(patch, indices, corner, kind, points);
            }
        }
        surface_.patchPoints = std::move(points);
    }

private:
    using PointIndices = std::span<const std::uint32_t>;

    /// Five points belong to each corner: itself, one along each of its sides, and two inside.
    [[nodiscard]] CornerKind kindOf(const Patch& patch, const PointIndices& indices, int corner) {
        if (!isFaceCorner(patch, surface_.sideCount, corner)) return CornerKind::plain;
        const std::uint32_t* points = &indices[5 * std::size_t(corner)];
        const RowAngles::Angle angle = angles_.measure(rows_, points[0], points[1], points[2]);
        const double length = angle.length * magnification(patch);
        // Tangents around many faces are short too, but they point somewhere.
        if (length > kNoTangent && angle.cosine > kNarrowCosine) return CornerKind::narrow;
        if (length < kVanishingTangent) return CornerKind::vanishing;
        return angle.cosine < kStraightCosine ? CornerKind::straight : CornerKind::plain;
    }

    /// Tangents around a vertex are t1 cos a + t2 sin a with equally long t1 and t2 that share no weight: angles
    /// between their weights are those between them.
    void findAxes() {
        std::map<std::uint32_t, std::vector<Axes>> corners; // by vertex: the two tangents' points of each narrow corner
        for (const Patch& patch : surface_.patches) {
            if (patch.type != kPatchGregory && patch.type != kPatchGregoryTriangle) continue;
            const auto indices = std::span(surface_.patchPoints).subspan(patch.firstPoint, patchSize(patch.type));
            for (int corner = 0; corner < surface_.sideCount; ++corner) {
                const std::uint32_t* p = &indices[5 * std::size_t(corner)];
                if (kindOf(patch, indices, corner) == CornerKind::narrow) corners[p[0]].push_back({p[1], p[2]});
            }
        }
        for (const auto& [vertex, around] : corners) axes_[vertex] = axesOf(vertex, around);
    }

    [[nodiscard]] Axes axesOf(std::uint32_t vertex, const std::vector<Axes>& around) {
        const auto cosine = [&](std::uint32_t a, std::uint32_t b) {
            return angles_.measure(rows_, vertex, a, b).cosine;
        };
        const auto [first, after] = around.front();
        std::uint32_t second = after;
        double best = 1;
        for (const Axes& other : around)
            if (const double c = cosine(first, other.first); std::abs(c) < best)
                best = std::abs(c), second = other.first;
        const bool isLeft = cosine(second, after) > cosine(first, after) * cosine(first, second);
        return isLeft ? Axes{first, second} : Axes{second, first};
    }

    static void addNarrowCorner(Patch& patch, int corner, const Axes& axes, std::vector<std::uint32_t>& points) {
        patch.straightCorners |= 1u << corner;
        points.insert(points.end(), {axes.first, axes.second});
    }

    static double magnification(const Patch& patch) {
        return std::ldexp(1.0, depthInFace({patch.param0, patch.param1}));
    }

    /// Appends the two points whose directions from the corner span the tangent plane there.
    void addCorner(Patch& patch, const PointIndices& indices, int corner, CornerKind kind,
                   std::vector<std::uint32_t>& points) {
        patch.straightCorners |= 1u << corner;
        const CornerDirections at = directionsAt(surface_.sideCount, corner);
        const PatchWeights weights = patch.type == kPatchGregory ? gregoryQuadWeights(at.uv.x, at.uv.y)
                                                                 : gregoryTriangleWeights(at.uv.x, at.uv.y);
        const double scale = magnification(patch);
        const dvec2 diagonal = at.next + at.previous;
        const auto first = [&](const Jet& w) { return scale * (w.u * at.next.x + w.v * at.next.y); };
        const auto second = [&](const Jet& w, const dvec2& by) {
            return scale * scale *
                   (diagonal.x * (w.uu * by.x + w.uv * by.y) + diagonal.y * (w.uv * by.x + w.vv * by.y));
        };
        const bool isStraight = kind == CornerKind::straight;
        std::array<RowTable::Entry, kMostPatchPoints> one, other;
        for (std::size_t i = 0; i < indices.size(); ++i) {
            const Jet& w = weights[i];
            one[i] = {indices[i], w.f + (isStraight ? first(w) : second(w, at.next))};
            other[i] = {indices[i], w.f + second(w, isStraight ? diagonal : at.previous)};
        }
        points.push_back(std::uint32_t(rows_.append(std::span(one).first(indices.size()))));
        points.push_back(std::uint32_t(rows_.append(std::span(other).first(indices.size()))));
    }

    Surface& surface_;
    RowTable& rows_;
    RowAngles angles_;
    std::map<std::uint32_t, Axes> axes_; ///< by the point of a vertex with narrow corners
};

} // namespace

void addStraightCorners(Surface& surface, RowTable& rows) { StraightCornerBuilder(surface, rows).build(); }

} // namespace relief

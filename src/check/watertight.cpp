#include <algorithm>
#include <bit>
#include <cmath>

#include "check/gaps.h"

namespace relief {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

bool isFinite(const vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

bool isSamePosition(const vec3& a, const vec3& b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

/// A mixer of 64 bits (the finaliser of MurmurHash3) over the bits of all coordinates; -0 counts as +0.
std::uint64_t hashOf(const vec3& p) {
    const auto bits = [](float x) { return std::uint64_t(std::bit_cast<std::uint32_t>(x + 0.0f)); };
    std::uint64_t h = (bits(p.x) | bits(p.y) << 32) * 0x9e3779b97f4a7c15ull ^ bits(p.z) * 0xc2b2ae3d27d4eb4full;
    h = (h ^ (h >> 33)) * 0xff51afd7ed558ccdull;
    h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53ull;
    return h ^ (h >> 33);
}

/// Distinct points, numbered in the order of their first vertex.
struct Weld {
    std::vector<std::uint32_t> pointOf;     ///< one per vertex; kNone where it is not finite
    std::vector<std::uint32_t> firstVertex; ///< one per point
    std::vector<char> isOnBoundary;         ///< one per point: any of its vertices is
};

/// An open-addressing table of points, at most half full.
Weld weld(const CapturedMesh& mesh) {
    Weld result;
    result.pointOf.assign(mesh.positions.size(), kNone);
    std::vector<std::uint32_t> table(std::bit_ceil(2 * mesh.positions.size() + 1), kNone);
    const std::uint64_t mask = table.size() - 1;
    for (std::uint32_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
        const vec3& p = mesh.positions[vertex];
        if (!isFinite(p)) continue;
        std::uint64_t slot = hashOf(p) & mask;
        while (table[slot] != kNone && !isSamePosition(mesh.positions[result.firstVertex[table[slot]]], p))
            slot = (slot + 1) & mask;
        if (table[slot] == kNone) {
            table[slot] = std::uint32_t(result.firstVertex.size());
            result.firstVertex.push_back(vertex);
            result.isOnBoundary.push_back(0);
        }
        result.pointOf[vertex] = table[slot];
        result.isOnBoundary[table[slot]] |= mesh.isOnBoundary[vertex];
    }
    return result;
}

struct Triangle {
    std::uint32_t points[3];

    [[nodiscard]] bool isFinite() const { return points[0] != kNone && points[1] != kNone && points[2] != kNone; }
    [[nodiscard]] bool isDegenerate() const {
        return points[0] == points[1] || points[1] == points[2] || points[2] == points[0];
    }
};

/// Counts edges by counting sort: each edge lies in the bucket of its lower point, with its upper point as the entry.
class EdgeCounter {
public:
    EdgeCounter(const CapturedMesh& mesh, Watertightness& result) : mesh_(mesh), weld_(weld(mesh)), result_(result) {}

    void count() {
        result_.distinctPoints = weld_.firstVertex.size();
        result_.notFinite = std::uint64_t(std::count(weld_.pointOf.begin(), weld_.pointOf.end(), kNone));
        sizeBuckets();
        fillBuckets();
        for (std::uint32_t lower = 0; lower + 1 < firsts_.size(); ++lower) countBucket(lower);
        diagnoseGaps(open_, boundary_, result_);
    }

private:
    template <typename Visit>
    void forTriangles(const Visit& visit) const {
        for (std::size_t i = 0; i < mesh_.indices.size(); i += 3)
            visit(Triangle{{weld_.pointOf[mesh_.indices[i]], weld_.pointOf[mesh_.indices[i + 1]],
                            weld_.pointOf[mesh_.indices[i + 2]]}});
    }

    /// Calls `visit(lower, upper)` for the edges of all triangles that have an area.
    template <typename Visit>
    void forEdges(const Visit& visit) const {
        forTriangles([&](const Triangle& triangle) {
            if (!triangle.isFinite() || triangle.isDegenerate()) return;
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t a = triangle.points[k], b = triangle.points[(k + 1) % 3];
                visit(std::min(a, b), std::max(a, b));
            }
        });
    }

    [[nodiscard]] bool isOnBoundary(std::uint32_t a, std::uint32_t b) const {
        return weld_.isOnBoundary[a] && weld_.isOnBoundary[b];
    }

    void sizeBuckets() {
        forTriangles([&](const Triangle& triangle) {
            if (!triangle.isFinite() || !triangle.isDegenerate()) return;
            ++result_.degenerateTriangles;
            for (int k = 0; k < 3; ++k)
                result_.hiddenBoundarySegments += isOnBoundary(triangle.points[k], triangle.points[(k + 1) % 3]);
        });
        firsts_.assign(weld_.firstVertex.size() + 1, 0);
        forEdges([&](std::uint32_t lower, std::uint32_t) { ++firsts_[lower + 1]; });
        for (std::size_t i = 1; i < firsts_.size(); ++i) firsts_[i] += firsts_[i - 1];
    }

    void fillBuckets() {
        uppers_.resize(firsts_.back());
        std::vector<std::uint64_t> next(firsts_.begin(), firsts_.end() - 1);
        forEdges([&](std::uint32_t lower, std::uint32_t upper) { uppers_[next[lower]++] = upper; });
    }

    void countBucket(std::uint32_t lower) {
        const auto begin = uppers_.begin() + std::ptrdiff_t(firsts_[lower]);
        const auto end = uppers_.begin() + std::ptrdiff_t(firsts_[lower + 1]);
        std::sort(begin, end);
        for (auto edge = begin; edge != end;) {
            const auto next = std::find_if(edge, end, [&](std::uint32_t upper) { return upper != *edge; });
            countEdge(lower, *edge, std::uint64_t(next - edge));
            edge = next;
        }
    }

    void countEdge(std::uint32_t a, std::uint32_t b, std::uint64_t uses) {
        const bool isBoundary = isOnBoundary(a, b);
        if (uses > 1) {
            if (isBoundary) result_.hiddenBoundarySegments += uses;
            return;
        }
        ++(isBoundary ? result_.boundarySegments : result_.openEdges);
        const LoneEdge edge{{mesh_.positions[weld_.firstVertex[a]], mesh_.positions[weld_.firstVertex[b]]}};
        std::vector<LoneEdge>& list = isBoundary ? boundary_ : open_;
        if (list.size() < kMostKeptEdges) list.push_back(edge);
    }

    const CapturedMesh& mesh_;
    Weld weld_;
    Watertightness& result_;
    std::vector<std::uint64_t> firsts_; ///< where the bucket of each point begins in uppers_; one more at the end
    std::vector<std::uint32_t> uppers_;
    std::vector<LoneEdge> open_, boundary_;
};

void checkArrays(const CapturedMesh& mesh) {
    if (mesh.isOnBoundary.size() != mesh.positions.size() || mesh.indices.size() % 3 != 0)
        fail(Failure::internal, "captured triangles have {} positions, {} boundary flags and {} indices",
             mesh.positions.size(), mesh.isOnBoundary.size(), mesh.indices.size());
    const auto isBad = [&](std::uint32_t index) { return index >= mesh.positions.size(); };
    const auto bad = std::find_if(mesh.indices.begin(), mesh.indices.end(), isBad);
    if (bad != mesh.indices.end())
        fail(Failure::internal, "captured triangle {} has vertex {}, but there are {}",
             (bad - mesh.indices.begin()) / 3, *bad, mesh.positions.size());
}

/// No path makes a triangle that has a vertex twice: what looks like one was never written.
std::uint64_t trianglesOf(const CapturedMesh& mesh) {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3)
        count += !Triangle{{mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]}}.isDegenerate();
    return count;
}

} // namespace

bool Watertightness::isBoundaryWhole() const {
    return boundarySegments <= expectedBoundarySegments &&
           boundarySegments + hiddenBoundarySegments >= expectedBoundarySegments;
}

bool Watertightness::isWatertight() const {
    return openEdges == 0 && tJunctions == 0 && notFinite == 0 && isBoundaryWhole() && hasAllTriangles();
}

Watertightness checkWatertight(const CapturedMesh& mesh, std::uint64_t expectedBoundarySegments,
                               std::optional<std::uint64_t> expectedTriangles) {
    checkArrays(mesh);
    Watertightness result{.triangles = trianglesOf(mesh),
                          .expectedTriangles = expectedTriangles,
                          .expectedBoundarySegments = expectedBoundarySegments};
    EdgeCounter(mesh, result).count();
    return result;
}

} // namespace relief

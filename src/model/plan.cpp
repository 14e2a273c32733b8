#include <algorithm>

#include "model/stages.h"

namespace relief {
namespace {

struct SideRates {
    std::uint32_t rates[4] = {};
    std::uint32_t largest = 1;
};

SideRates sideRates(const Model& model, const Face& face, std::span<const std::uint32_t> edgeRates) {
    SideRates sides;
    for (int side = 0; side < model.sideCount(); ++side) {
        const std::uint32_t entry = face.sides[side];
        const std::uint32_t rate = edgeRates[entry & kSideEdgeMask];
        sides.rates[side] = (entry & kSideSplit) != 0 ? 2 * rate : rate;
        sides.largest = std::max(sides.largest, sides.rates[side]);
    }
    return sides;
}

/// The tessellator's concentric triangles, all sides with n segments.
std::uint64_t evenTriangle(std::uint64_t n) { return n % 2 == 0 ? 3 * n * n / 2 : (3 * n * n - 1) / 2; }

/// Vertices inside a tessellated triangle with n segments a side: the ring of the triangle two segments smaller, and so
/// on.
std::uint64_t insideTriangle(std::uint64_t n) {
    return n < 3 ? n - 1 : 3 * (n - 2) + (n == 3 ? 0 : insideTriangle(n - 2));
}

/// Corners and samples along edges, each once whatever faces share them.
std::uint64_t sharedVertices(const Model& model, std::span<const std::uint32_t> edgeRates) {
    std::uint64_t count = model.cornerCount();
    for (const std::uint32_t rate : edgeRates) count += rate - 1;
    return count;
}

} // namespace

std::uint64_t tessellatedTriangles(std::span<const std::uint32_t> r) {
    const std::uint64_t sum = std::uint64_t(r[0]) + r[1] + r[2] + (r.size() == 4 ? r[3] : 0);
    if (sum == r.size()) return r.size() - 2;
    if (r.size() == 3) {
        const std::uint64_t n = std::max({r[0], r[1], r[2]});
        return sum + 3 * (n - 2) + evenTriangle(n - 2);
    }
    // An outer ring that joins each side to an inner grid two segments smaller. An inner level of 1 beside others
    // counts 2.
    const std::uint64_t m = std::max({r[0], r[2], 2u}), n = std::max({r[1], r[3], 2u});
    return sum + 2 * (m - 2) + 2 * (n - 2) + 2 * (m - 2) * (n - 2);
}

DrawPlan planPatches(const Model& model, std::span<const std::uint32_t> edgeRates, std::uint32_t verticesPerDraw) {
    DrawPlan plan;
    plan.vertexCount = sharedVertices(model, edgeRates);
    std::uint64_t vertices = 0;
    for (std::uint32_t f = 0; f < model.faces().size(); ++f) {
        const Face& face = model.faces()[f];
        if (face.root == kNoPatch) continue;
        const SideRates sides = sideRates(model, face, edgeRates);
        const std::uint64_t more = std::uint64_t(sides.largest + 1) * (sides.largest + 1);
        if (plan.batches.empty() || vertices + more > verticesPerDraw) {
            plan.batches.push_back({.firstFace = std::uint32_t(plan.faces.size())});
            vertices = 0;
        }
        vertices += more;
        ++plan.batches.back().faceCount;
        plan.faces.push_back(f);
        plan.triangleCount += tessellatedTriangles({sides.rates, std::size_t(model.sideCount())});
        const std::uint64_t m = std::max(sides.rates[0], sides.rates[2]), n = std::max(sides.rates[1], sides.rates[3]);
        plan.vertexCount += model.isTriangles() ? insideTriangle(sides.largest)
                            : sides.largest == 1
                                ? 0
                                : (std::max<std::uint64_t>(m, 2) - 1) * (std::max<std::uint64_t>(n, 2) - 1);
        plan.maxRate = std::max(plan.maxRate, sides.largest);
    }
    return plan;
}

DrawPlan planGrids(const Model& model, std::span<const std::uint32_t> edgeRates) {
    std::map<std::uint32_t, std::vector<std::uint32_t>> groups;
    for (std::uint32_t f = 0; f < model.faces().size(); ++f)
        if (model.faces()[f].root != kNoPatch)
            groups[sideRates(model, model.faces()[f], edgeRates).largest].push_back(f);
    DrawPlan plan;
    plan.vertexCount = sharedVertices(model, edgeRates);
    for (const auto& [rate, faces] : groups) {
        plan.batches.push_back({rate, std::uint32_t(plan.faces.size()), std::uint32_t(faces.size())});
        plan.faces.insert(plan.faces.end(), faces.begin(), faces.end());
        plan.triangleCount += faces.size() * std::uint64_t(rate) * rate * (model.isTriangles() ? 1 : 2);
        const std::uint64_t inside = model.isTriangles() ? std::uint64_t(rate - 1) * (std::max(rate, 2u) - 2) / 2
                                                         : std::uint64_t(rate - 1) * (rate - 1);
        plan.vertexCount += faces.size() * inside;
        plan.maxRate = std::max(plan.maxRate, rate);
    }
    return plan;
}

std::vector<std::uint32_t> gridIndices(std::uint32_t n, bool isTriangles) {
    std::vector<std::uint32_t> indices;
    indices.reserve(std::size_t(n) * n * 6);
    const auto at = [n](std::uint32_t i, std::uint32_t j) { return j * (n + 1) + i; };
    for (std::uint32_t j = 0; j < n; ++j)
        for (std::uint32_t i = 0; i < (isTriangles ? n - j : n); ++i) {
            indices.insert(indices.end(), {at(i, j), at(i + 1, j), at(i, j + 1)});
            if (!isTriangles || i + j + 2 <= n)
                indices.insert(indices.end(), {at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return indices;
}

} // namespace relief

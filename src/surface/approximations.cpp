// Which faces hold patches that are not the limit surface although exact end caps were asked for.
#include <algorithm>

#include "surface/far.h"

namespace relief {
namespace {

/// The numbers of faces around the vertices.
std::vector<int> countFaces(const Cage& cage) {
    std::vector<int> counts(cage.positions.size());
    for (const std::uint32_t vertex : cage.corners) ++counts[vertex];
    return counts;
}

/// True without a look at patches: vertices are apart from each other, no semi-sharp rule goes on, and no vertex has
/// more faces than any pattern.
bool isSurelyExact(const Cage& cage, const SurfaceOptions& options) {
    constexpr int kSeparating = 2;
    if (options.scheme == Scheme::bilinear || options.endCaps == EndCapKind::gregory) return true;
    if (options.isolation < kSeparating || hasFiniteSharpnessPast(cage, options.isolation)) return false;
    const auto isLarge = [](int faceCount) { return faceCount > kMostCapFaces; };
    return std::ranges::none_of(countFaces(cage), isLarge);
}

} // namespace

bool hasFiniteSharpnessPast(const Cage& cage, int isolation) {
    const auto isPast = [&](float sharpness) {
        return sharpness > float(isolation) && sharpness < OpenSubdiv::Sdc::Crease::SHARPNESS_INFINITE;
    };
    return std::ranges::any_of(cage.creaseSharpness, isPast) || std::ranges::any_of(cage.vertexSharpness, isPast);
}

bool hasLargeSharpVertex(const Cage& cage) {
    const std::vector<int> faceCounts = countFaces(cage);
    const auto isLarge = [&](std::uint32_t vertex) { return faceCounts[vertex] > kMostCapFaces; };
    if (std::ranges::any_of(cage.creaseEdges, isLarge) || std::ranges::any_of(cage.sharpVertices, isLarge)) return true;
    // Around a vertex inside the surface as many edges arrive as leave, at the same vertices.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> leaving, arriving;
    std::size_t first = 0;
    for (const std::uint32_t size : cage.faceSizes) {
        for (std::uint32_t i = 0; i < size; ++i) {
            const std::uint32_t vertex = cage.corners[first + i];
            if (!isLarge(vertex)) continue;
            leaving.emplace_back(vertex, cage.corners[first + (i + 1) % size]);
            arriving.emplace_back(vertex, cage.corners[first + (i + size - 1) % size]);
        }
        first += size;
    }
    std::ranges::sort(leaving), std::ranges::sort(arriving);
    return leaving != arriving;
}

std::vector<std::uint32_t> listApproximateFaces(const Cage& cage, const SurfaceOptions& options,
                                                const Surface* surface) {
    if (isSurelyExact(cage, options)) return {};
    if (!surface) {
        const Surface built = buildSurface(cage, options);
        return listApproximateFaces(cage, options, &built);
    }
    const bool isCutShort = hasFiniteSharpnessPast(cage, options.isolation);
    std::vector<std::uint32_t> faces;
    for (const Patch& patch : surface->patches) {
        const Far::PatchParam param{patch.param0, patch.param1};
        const bool isGregory = patch.type == kPatchGregory || patch.type == kPatchGregoryTriangle;
        if (isGregory || (isCutShort && param.GetDepth() >= options.isolation))
            faces.push_back(surface->faces[std::size_t(param.GetFaceId())].cageFace);
    }
    std::ranges::sort(faces);
    faces.erase(std::ranges::unique(faces).begin(), faces.end());
    return faces;
}

} // namespace relief

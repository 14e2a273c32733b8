#include "cage/faces.h"

#include <algorithm>

#include "cage/edges.h"

namespace relief {

namespace {

constexpr std::uint32_t kRemoved = ~0u;

/// Moves the entries of kept corners to the front; `kept` counts through the whole array.
void keepEntries(std::vector<std::uint32_t>& entries, const std::vector<std::uint32_t>& kept) {
    if (entries.empty()) return;
    for (std::size_t i = 0; i < kept.size(); ++i) entries[i] = entries[kept[i]];
    entries.resize(kept.size());
}

/// Corners and face sizes without what is degenerate. Returns the new number of each face, or kRemoved.
std::vector<std::uint32_t> removeCorners(Cage& cage) {
    std::vector<std::uint32_t> newFaces(cage.faceCount(), kRemoved), sizes, kept, ofFace;
    std::uint32_t first = 0;
    for (std::size_t face = 0; face < cage.faceCount(); ++face) {
        const std::uint32_t size = cage.faceSizes[face];
        findSoundCorners(std::span(cage.corners).subspan(first, size), ofFace);
        if (!ofFace.empty()) {
            newFaces[face] = std::uint32_t(sizes.size());
            sizes.push_back(std::uint32_t(ofFace.size()));
        }
        for (const std::uint32_t corner : ofFace) kept.push_back(first + corner);
        first += size;
    }
    for (auto* entries : {&cage.corners, &cage.texCorners, &cage.normalCorners}) keepEntries(*entries, kept);
    cage.faceSizes = std::move(sizes);
    return newFaces;
}

void renumberHoles(Cage& cage, const std::vector<std::uint32_t>& newFaces) {
    for (std::uint32_t& hole : cage.holes) hole = newFaces[hole];
    std::erase(cage.holes, kRemoved);
}

void shortenParts(Cage& cage, const std::vector<std::uint32_t>& newFaces) {
    std::uint32_t first = 0;
    for (CagePart& part : cage.parts) {
        const auto begin = newFaces.begin() + part.firstFace, end = begin + part.faceCount;
        part.faceCount -= std::uint32_t(std::count(begin, end, kRemoved));
        part.firstFace = first;
        first += part.faceCount;
    }
    std::erase_if(cage.parts, [](const CagePart& part) { return part.faceCount == 0; });
}

void removeLostCreases(Cage& cage) {
    if (cage.creaseEdges.empty()) return;
    const std::vector<EdgeUse> uses = sortedEdgeUses(cage);
    std::size_t count = 0;
    for (std::size_t i = 0; i < cage.creaseSharpness.size(); ++i) {
        const std::uint32_t a = cage.creaseEdges[2 * i], b = cage.creaseEdges[2 * i + 1];
        if (!hasEdge(uses, a, b)) continue;
        cage.creaseEdges[2 * count] = a;
        cage.creaseEdges[2 * count + 1] = b;
        cage.creaseSharpness[count++] = cage.creaseSharpness[i];
    }
    cage.creaseEdges.resize(2 * count);
    cage.creaseSharpness.resize(count);
}

} // namespace

void findSoundCorners(std::span<const std::uint32_t> vertices, std::vector<std::uint32_t>& kept) {
    kept.clear();
    for (std::uint32_t corner = 0; corner < vertices.size(); ++corner)
        if (kept.empty() || vertices[kept.back()] != vertices[corner]) kept.push_back(corner);
    while (kept.size() > 1 && vertices[kept.back()] == vertices[kept.front()]) kept.pop_back();

    std::vector<std::uint32_t> sorted;
    sorted.reserve(kept.size());
    for (const std::uint32_t corner : kept) sorted.push_back(vertices[corner]);
    std::ranges::sort(sorted);
    if (kept.size() < 3 || std::ranges::adjacent_find(sorted) != sorted.end()) kept.clear();
}

void removeDegenerateFaces(Cage& cage) {
    const std::size_t cornerCount = cage.corners.size();
    const std::vector<std::uint32_t> newFaces = removeCorners(cage);
    if (cage.corners.size() == cornerCount) return;
    renumberHoles(cage, newFaces);
    shortenParts(cage, newFaces);
    removeLostCreases(cage);
}

} // namespace relief

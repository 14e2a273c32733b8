// Who shares edges and corners of faces with whom, for maps per face.
#include "displacement/displacement.h"

namespace relief {
namespace {

/// How many faces of four corners meet at each corner, the straight side of one counting as two.
std::vector<std::uint32_t> countFaces(const Surface& surface) {
    std::vector<std::uint32_t> counts(surface.corners.size(), 0);
    for (const Face& face : surface.faces) {
        if (face.root == kNoPatch) continue;
        for (const std::uint32_t entry : face.sides) {
            const std::uint32_t edge = entry & kSideEdgeMask;
            const bool isReversed = (entry & kSideReversed) != 0, isSplit = (entry & kSideSplit) != 0;
            const Edge& first = surface.edges[edge + (isSplit && isReversed ? 1 : 0)];
            ++counts[first.corners[isReversed ? 1 : 0]];
            if (isSplit) counts[surface.edges[edge].corners[1]] += 2;
        }
    }
    return counts;
}

/// The corner where a side begins.
std::uint32_t cornerAt(const Surface& surface, std::uint32_t entry) {
    const std::uint32_t edge = entry & kSideEdgeMask;
    if ((entry & kSideReversed) == 0) return surface.edges[edge].corners[0];
    return surface.edges[edge + ((entry & kSideSplit) != 0 ? 1 : 0)].corners[1];
}

} // namespace

FaceLinks linkFaces(const Surface& surface) {
    if (surface.sideCount != 4)
        fail(Failure::usage, "maps per face are for faces with four sides; use --scheme catmark or bilinear");
    FaceLinks result;
    result.links.resize(8 * surface.faces.size());
    result.cornerOwners.assign(4 * surface.faces.size(), Incidence{kNoPatch, 0, 0, 0});
    result.isOneSided.assign(4 * surface.faces.size(), false);

    // Edges: of two faces each is the other's neighbour; of more the owner gives its heights, and slopes end there.
    const EdgeIncidences incidences = edgeIncidences(surface);
    for (std::size_t edge = 0; edge < surface.edges.size(); ++edge) {
        const std::span<const Incidence> faces = incidences.of(edge);
        for (std::size_t i = 0; i < faces.size() && faces.size() > 1; ++i) {
            const std::size_t other = i > 0 ? 0 : 1;
            const Incidence &own = faces[i], &across = faces[other];
            FaceLink* links = &result.links[8 * own.face + 2 * own.side];
            FaceLink& link = links[links[0].face == kNoPatch ? 0 : 1];
            link = {.face = across.face,
                    .side = across.side,
                    .ownStart = own.start,
                    .ownEnd = own.end,
                    .start = across.start,
                    .end = across.end,
                    .isOwner = i > 0,
                    .continues = faces.size() == 2};
        }
    }

    // Corners: the rows of nodes run on where as many faces meet as in a regular grid.
    const std::vector<std::uint32_t> counts = countFaces(surface);
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
        if (surface.faces[f].root == kNoPatch) continue;
        for (std::size_t c = 0; c < 4; ++c) {
            const std::uint32_t index = cornerAt(surface, surface.faces[f].sides[c]);
            const Corner& corner = surface.corners[index];
            result.cornerOwners[4 * f + c] = corner.owner;
            result.isOneSided[4 * f + c] = counts[index] != ((corner.flags & kOnBoundary) != 0 ? 2u : 4u);
        }
    }
    return result;
}

std::uint64_t hashTopology(const Cage& cage) {
    // FNV-1a over whole words.
    std::uint64_t hash = 0xcbf29ce484222325u;
    const auto add = [&](std::uint64_t word) { hash = (hash ^ word) * 0x100000001b3u; };
    add(cage.positions.size());
    add(cage.faceSizes.size());
    for (const std::uint32_t size : cage.faceSizes) add(size);
    for (const std::uint32_t corner : cage.corners) add(corner);
    for (const std::uint32_t hole : cage.holes) add(hole);
    return hash;
}

} // namespace relief

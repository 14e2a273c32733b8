// Vertices of a cage that are joined, and warnings of cages that look as if they needed it or another option.
#include "scene/loading.h"

namespace relief {
namespace {

std::string toText(const Distance& distance) {
    return distance.isShare ? fmt::format("{:g}%", 100 * distance.value) : fmt::format("{:g}", distance.value);
}

WeldedCage weldWithin(Cage cage, const Distance& distance) {
    const double diagonal = summarize(cage).bounds.diagonal(), unit = cage.coordinates.unit;
    WeldedCage welded = weld(std::move(cage), distance.cageUnits(diagonal) / unit);
    if (welded.cage.faceCount() == 0)
        fail(Failure::usage, "--weld {}: all faces shrink to nothing; use a smaller distance", toText(distance));
    return welded;
}

} // namespace

Cage weldCage(Cage cage, const std::optional<Distance>& distance) {
    return distance ? weldWithin(std::move(cage), *distance).cage : std::move(cage);
}

void weldObject(LoadedObject& object, const Distance& distance) {
    WeldedCage welded = weldWithin(std::move(object.cage), distance);
    object.cage = std::move(welded.cage);
    if (object.animation) object.animation = gather(std::move(object.animation), std::move(welded.sources));
}

void warnOfCoincidentVertices(const Cage& cage, const std::string& path, const Warn& warn) {
    const std::uint64_t count = countCoincidentVertices(cage);
    if (count > 0)
        warn(fmt::format("{}: {} of {} vertices are at the position of another boundary vertex: the surface is open "
                         "between them; --weld joins them",
                         path, count, cage.positions.size()));
}

void warnOfUnusedTags(const LoadedObject& object, const ObjectDesc& desc, const Warn& warn) {
    const Cage& cage = object.cage;
    const bool hasTags = !cage.creaseEdges.empty() || !cage.sharpVertices.empty() || !cage.holes.empty();
    if (object.dense && !desc.subdivision && hasTags)
        warn(fmt::format("{}: it has subdivision tags, but triangles are drawn as they are; name --scheme loop or "
                         "catmark to subdivide them",
                         desc.cage));
}

void checkTexCoords(const Cage& cage, const std::vector<std::string>& maps, const Warn& warn) {
    if (cage.missingTexCoords.empty()) return;
    for (const std::string& map : maps)
        if (!map.empty()) fail(Failure::input, "{}; the map {} needs them on all faces", cage.missingTexCoords, map);
    warn(cage.missingTexCoords + "; all are ignored");
}

} // namespace relief

// The maps that `relief bake` makes, and their files.
#pragma once

#include "app/bake_options.h"
#include "app/bake_report.h"

namespace relief::app {

/// A cage's surface, the sculpt beside it, and where lines from one to the other begin. The parts refer to each other.
class BakePair {
public:
    /// Throws as load, readSculpt and MeasuredSurface do, Failure::usage for a cage that is drawn as polygons, and
    /// Failure::input for one without what its map needs and for a --cage of another topology.
    BakePair(const BakeArgs& args, const Warn& warn);
    BakePair(const BakePair&) = delete;
    BakePair& operator=(const BakePair&) = delete;

    LoadedObject object;
    ReferenceSurface reference;
    std::optional<ReferenceSurface> lineCage; ///< LineSearch::cage
    DisplacementDirections directions;
    Bounds sculptBox; ///< filled in with the sculpt, as is the count: before it
    std::uint64_t triangleCount = 0;
    MeasuredSurface sculpt;
    double unit = 1, diagonal = 1; ///< cage units per unit of the surfaces; of the sculpt's box in cage units
    LineSearch lines;

private:
    [[nodiscard]] MeasuredSurface loadSculpt(const BakeArgs& args, const Warn& warn);
};

/// Bakes all maps that are asked for and writes them. Fills in what the report says of texels, and returns the heights
/// as the file holds them, in cage units. Throws as bakeHeights and writeImage do, and Failure::input where no texel
/// lies on the surface and for tiles that the name cannot number.
HeightMap bakeMaps(const BakeArgs& args, const BakePair& pair, BakeReport& report);

} // namespace relief::app

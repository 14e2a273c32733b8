// Sculpts: the dense surfaces that maps are made from.
#pragma once

#include "bake/lines.h"
#include "base/base.h"
#include "distance/distance.h"
#include "mesh/mesh.h"
#include "surface/surface.h"

namespace relief {

/// Reads the triangles of a .ply, .stl, .obj, .gltf or .glb, in `coordinates`. Polygons become fans.
/// Throws as readTriangles and readCage do, and Failure::input where no triangle has an area.
TriangleMesh readSculpt(const std::string& path, const Coordinates& coordinates, const Warn& warn = warnOnStderr);

/// What is odd about the triangles of a sculpt. Vertices at equal positions count as one.
struct SculptFaults {
    std::uint64_t turnedCount = 0;        ///< triangles that were turned over, because most around them run otherwise
    std::uint64_t nonManifoldCount = 0;   ///< edges of more than two triangles
    std::uint64_t boundaryCount = 0;      ///< edges of one triangle
    std::uint64_t nonOrientableCount = 0; ///< edges whose two triangles cannot be wound alike
};

/// Turns triangles over so that those that share an edge run along it in opposite directions; in each connected part
/// the fewer ones are turned. Edges of more than two triangles connect nothing.
SculptFaults windAlike(TriangleMesh& mesh);

/// How the sculpt looks from the surface: the sides of its triangles that the hits of lines along the normals see.
struct SculptSides {
    std::uint64_t lineCount = 0, frontCount = 0, backCount = 0;

    /// The side to take hits of.
    [[nodiscard]] Facing facing() const { return backCount > frontCount ? Facing::back : Facing::front; }
};

/// Looks at the sculpt along the lines of some thousand points of the surface.
SculptSides findSides(const ReferenceSurface& surface, const MeasuredSurface& sculpt, const LineSearch& lines);

} // namespace relief

// Internal: the border of a disk on the border of a square.
#pragma once

#include "geometry_image/topology.h"

namespace relief {

/// The border of a disk and how many segments each of its paths gets.
struct SquareBorder {
    Disk disk;
    std::vector<BorderPath> paths;
    Sewing sewing;
};

/// Allots whole segments of the coarsest mip to paths by their lengths: mates get as many, nodes lie on samples of
/// every mip. The square's corners stay away from the ends of cuts, and meet corners of boundaries where they can.
/// The mesh gets vertices where the corners fall, and within edges between two points of the border, so that no
/// triangle lies along a side. `size` is that of the image. Throws Failure::input where it is too small.
SquareBorder fitSquare(CutMesh& mesh, int size, const std::string& name);

/// Places of the copies on the border around the unit square; others are (0,0).
std::vector<dvec2> placeOnSquare(const CutMesh& mesh, const SquareBorder& border);

} // namespace relief

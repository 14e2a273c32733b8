// Internal: cutting a surface of any genus open to a disk.
#pragma once

#include "geometry_image/topology.h"

namespace relief {

/// A chain of half-edges, each from the end of the one before.
struct Route {
    std::vector<std::uint32_t> halfEdges;
    double length = 0;
};

/// Marks edges so that cutting them makes one disk (Gu et al. 2002, section 3.1): a disk of triangles grows over the
/// surface, what it does not cross is the cut, and ends that lead nowhere are removed. A sphere, where nothing is left,
/// is cut from one of its extreme points to another. Boundaries are borders already.
void cutToDisk(CutMesh& mesh);

/// Replaces paths of the cut by shorter ones that make a disk as well. Without a path the disk is a ring, which any
/// route between its two borders cuts open again: the shortest one is taken, wherever it begins and ends.
void shortenPaths(CutMesh& mesh);

/// Moves the vertices of paths along the surface, where it is nearly flat around them, so that paths along edges become
/// smooth: between samples that are farther apart than its corners, a zigzag would fold.
void smoothPaths(CutMesh& mesh);

/// The shortest route along edges inside of the disk from a copy to the border; empty where there is none.
Route findRouteToBorder(const CutMesh& mesh, const Disk& disk, std::uint32_t start);

} // namespace relief

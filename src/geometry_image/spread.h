// Internal: spreading a disk over a convex shape, with its border held.
#pragma once

#include "geometry_image/topology.h"

namespace relief {

/// How much a map from the plane to the surface stretches lengths (Sander et al. 2001, section 3).
struct Stretch {
    double total = 0;              ///< L2 of the whole map, by area; 1 is the least
    std::vector<double> perVertex; ///< root mean square of the triangles around each copy, relative to the mean
};
Stretch measureStretch(const CutMesh& mesh, const Disk& disk, std::span<const dvec2> st);

/// Where each copy lies in the plane.
struct SpreadMap {
    std::vector<dvec2> st;
    double stretch = 0, firstStretch = 0;
};

/// Places of the copies on the border around the unit circle, by length along the border; others are (0,0).
std::vector<dvec2> placeOnCircle(const CutMesh& mesh, const Disk& disk, std::span<const BorderPath> border);

/// Spreads the disk with its border at `border`, which is convex and holds the border in order: each inner copy is the
/// mean of its neighbours, weighted by mean value coordinates (Floater 2003) made symmetric, or by cotangents where
/// none is negative: no triangle turns over (Tutte 1963; Floater 1997). `steps`: how many times the weights are divided
/// by the stretch at both ends of their edge (Yoshizawa, Belyaev and Seidel 2004, eq. 4), which moves points to where
/// the map stretches most; the map of the least stretch is the result.
SpreadMap spreadInside(const CutMesh& mesh, const Disk& disk, std::vector<dvec2> border, int steps);

/// Moves all inner copies together, downhill: to where the L2 stretch of triangles is smaller (Sander et al. 2001,
/// section 3), and rows and columns of samples meet at wider angles. No triangle turns over. `steps`: at most; it ends
/// where a step gains less than a thousandth of the energy, or where there is no step downhill.
void relaxInside(const CutMesh& mesh, const Disk& disk, std::vector<dvec2>& st, int steps);

} // namespace relief

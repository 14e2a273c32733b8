// Internal: the samples of a square's grid, inside and along its border.
#pragma once

#include "geometry_image/topology.h"

namespace relief {

/// A point of the surface; the normal need not be of unit length.
struct SurfaceSample {
    dvec3 position{0}, normal{0};
};

/// The sample of an image at a step of its border, counterclockwise from the lower left corner; steps wrap around.
inline std::size_t borderSample(int step, int size) {
    const int n = size - 1;
    step %= 4 * n;
    const int along = step % n;
    const ivec2 places[4] = {{along, n}, {n, n - along}, {n - along, 0}, {0, along}};
    const ivec2 place = places[step / n];
    return std::size_t(place.y) * std::size_t(size) + std::size_t(place.x);
}

/// Evaluates the surface at the samples inside of an image, row by row from the top; those on the border stay 0.
std::vector<SurfaceSample> sampleGrid(const CutMesh& mesh, const Disk& disk, std::span<const dvec2> st, int size);

} // namespace relief

#include "base/clock.h"
#include "surface/far.h"

namespace relief {
namespace {

template <typename T>
std::uint64_t bytesOf(const std::vector<T>& array) {
    return array.size() * sizeof(T);
}

} // namespace

std::uint64_t Surface::byteCount() const {
    return bytesOf(faces) + bytesOf(tree) + bytesOf(patches) + bytesOf(patchPoints) + bytesOf(stencils.offsets) +
           bytesOf(stencils.indices) + bytesOf(stencils.weights) + bytesOf(stencils.scales) + bytesOf(capTables) +
           bytesOf(capWeights) + bytesOf(texPoints) + bytesOf(texPatchPoints) + bytesOf(texCaps) + bytesOf(edges) +
           bytesOf(corners) + bytesOf(incidences) + bytesOf(sectorFaces);
}

dvec2 sidePoint(int sideCount, int side, double x) {
    if (sideCount == 3) {
        const dvec2 points[] = {{x, 0}, {1 - x, x}, {0, 1 - x}};
        return points[side];
    }
    const dvec2 points[] = {{x, 0}, {1, x}, {1 - x, 1}, {0, 1 - x}};
    return points[side];
}

Surface buildSurface(const Cage& cage, const SurfaceOptions& options) {
    const double start = secondsNow();
    Surface surface;
    surface.scheme = options.scheme;
    surface.sideCount = options.scheme == Scheme::loop ? 3 : 4;
    FarTables tables = makeFarTables(cage, options);
    fillPatches(surface, tables);
    fillOwners(surface, tables, cage);
    fillTexPoints(surface, tables, cage.texCoords);
    fillStencils(surface, std::move(tables));
    surface.tableSeconds = secondsNow() - start;
    return surface;
}

} // namespace relief

#include "surface/flat_surface.h"

#include <gtest/gtest.h>

namespace relief {
namespace {

std::uint32_t boundaryMask(std::uint32_t param1) { return (param1 >> 7) & 0x1f; }

/// Uniform cubic B-spline; a boundary's phantom point is replaced by 2 p1 - p2.
std::array<double, 4> bspline(double t, bool isStartBoundary, bool isEndBoundary) {
    const double s = 1 - t;
    std::array<double, 4> w{s * s * s / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (3 * s * s * s - 6 * s * s + 4) / 6,
                            t * t * t / 6};
    if (isStartBoundary) w = {0, w[1] + 2 * w[0], w[2] - w[0], w[3]};
    if (isEndBoundary) w = {w[0], w[1] - w[3], w[2] + 2 * w[3], 0};
    return w;
}

/// Sides 0..3 (v=0, u=1, v=1, u=0) are bits 0..3 of the mask.
std::vector<double> regularWeights(const dvec2& uv, std::uint32_t boundary) {
    const auto wu = bspline(uv.x, boundary & 8, boundary & 2), wv = bspline(uv.y, boundary & 1, boundary & 4);
    std::vector<double> weights;
    for (const double v : wv)
        for (const double u : wu) weights.push_back(u * v);
    return weights;
}

std::vector<double> bilinearWeights(const dvec2& uv) {
    const double u = uv.x, v = uv.y;
    return {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
}

/// The value of an exact cap; `point(i)` is its i-th control point.
template <typename V, typename PointAt>
V capValue(const Surface& surface, std::uint32_t cap, const dvec2& uv, const PointAt& point) {
    const CapTable& table = surface.capTables.at(cap / 4);
    const std::uint32_t corner = cap % 4;
    const double w = 1 - uv.x - uv.y;
    const dvec2 quads[] = {uv, {uv.y, 1 - uv.x}, dvec2(1) - uv, {1 - uv.y, uv.x}},
                triangles[] = {uv, {uv.y, w}, {w, uv.x}};
    const dvec2 at = surface.sideCount == 4 ? quads[corner] : triangles[corner];
    const CapPlace place = placeInCap(surface.sideCount, at.x, at.y, int(kCapLevels));
    const V limit = point(0);
    if (place.level == 0) return limit;
    const std::vector<Jet> basis = pieceBasis(surface.sideCount, place.u, place.v);
    // Where the weight of a control point stands among those of a point on a level.
    const auto slot = [&](int j) {
        if (surface.sideCount == 3) return 12 * place.piece + j;
        const int x = j % 4 - (place.piece == 2 ? 1 : 0), y = j / 4 - (place.piece == 0 ? 1 : 0);
        return y < 0 ? x : x < 0 ? 20 + y : 4 + 4 * y + x;
    };
    const std::size_t slots = surface.sideCount == 3 ? 36 : 24;
    V sum(0);
    for (std::uint32_t i = 0; i < table.pointCount; ++i)
        for (std::size_t j = 0; j < basis.size(); ++j) {
            const std::size_t row = std::size_t(place.level - 1) * table.pointCount + i;
            const float weight = surface.capWeights.at(table.firstWeight + row * slots + std::size_t(slot(int(j))));
            sum += place.size * basis[j].f * double(weight) * (point(i) - limit);
        }
    return limit + sum;
}

bool isExactCap(std::uint32_t type) { return type == kPatchExactQuad || type == kPatchExactTriangle; }

} // namespace

Leaf findLeaf(const Surface& surface, std::uint32_t face, dvec2 uv) {
    std::uint32_t entry = surface.faces[face].root;
    int depth = 0;
    while (entry != kNoPatch && !(entry & kLeafBit)) {
        int child = 0;
        if (surface.sideCount == 4)
            child = (uv.x >= 0.5 ? 1 : 0) + (uv.y >= 0.5 ? 2 : 0);
        else
            child = uv.x >= 0.5 ? 1 : uv.y >= 0.5 ? 2 : uv.x + uv.y >= 0.5 ? 3 : 0;
        if (surface.sideCount == 3 && child == 3)
            uv = (dvec2(0.5) - uv) * 2.0;
        else
            uv = 2.0 * uv - dvec2(child == 1 || child == 3, child == 2 || child == 3);
        entry = surface.tree.at(entry + child);
        ++depth;
    }
    return {entry == kNoPatch ? kNoPatch : entry & ~kLeafBit, uv, depth};
}

FlatSurface::FlatSurface(const Cage& cage, const SurfaceOptions& options)
    : surface_(buildSurface(cage, options)), points_(refinePoints(surface_, cage.positions)),
      tables_(makeFarTables(cage, options)) {
    for (int array = 0, patch = 0; array < tables_.patches->GetNumPatchArrays(); ++array) {
        for (int i = 0; i < tables_.patches->GetNumPatches(array); ++i) {
            Far::PatchTable::PatchHandle handle;
            handle.arrayIndex = array;
            handle.patchIndex = patch++;
            handle.vertIndex = i * tables_.patches->GetPatchArrayDescriptor(array).GetNumControlVertices();
            handles_.push_back(handle);
        }
    }
}

dvec3 FlatSurface::position(std::uint32_t face, const dvec2& uv) const {
    const Leaf leaf = findLeaf(surface_, face, uv);
    const Patch& patch = surface_.patches.at(leaf.patch);
    if (isExactCap(patch.type))
        return capValue<dvec3>(surface_, patch.cap, leaf.uv, [&](std::uint32_t i) {
            return points_.at(surface_.patchPoints.at(patch.firstPoint + i));
        });
    const auto w = weights(leaf.patch, leaf, uv);
    dvec3 p(0);
    for (std::size_t i = 0; i < w.size(); ++i) p += w[i] * points_.at(surface_.patchPoints.at(patch.firstPoint + i));
    return p;
}

dvec2 FlatSurface::texCoord(std::uint32_t face, const dvec2& uv) const {
    const Leaf leaf = findLeaf(surface_, face, uv);
    const Patch& patch = surface_.patches.at(leaf.patch);
    if (isExactCap(patch.texType))
        return capValue<dvec2>(surface_, surface_.texCaps.at(leaf.patch), leaf.uv, [&](std::uint32_t i) {
            return dvec2(surface_.texPoints.at(surface_.texPatchPoints.at(patch.texFirstPoint + i)));
        });
    const auto w = texWeights(leaf.patch, leaf, uv);
    dvec2 st(0);
    for (std::size_t i = 0; i < w.size(); ++i)
        st += w[i] * dvec2(surface_.texPoints.at(surface_.texPatchPoints.at(patch.texFirstPoint + i)));
    return st;
}

std::vector<double> FlatSurface::weights(std::uint32_t index, const Leaf& leaf, const dvec2& uv) const {
    const Patch& patch = surface_.patches[index];
    if (patch.type == kPatchRegular) return regularWeights(leaf.uv, boundaryMask(patch.param1));
    if (patch.type == kPatchQuads) return bilinearWeights(leaf.uv);
    std::vector<double> w(20);
    tables_.patches->EvaluateBasis(handles_[index], uv.x, uv.y, w.data());
    w.resize(patch.type == kPatchLoop ? 12 : patch.type == kPatchGregoryTriangle ? 18 : 20);
    return w;
}

std::vector<double> FlatSurface::texWeights(std::uint32_t index, const Leaf& leaf, const dvec2& uv) const {
    const Patch& patch = surface_.patches[index];
    if (patch.texType == kPatchRegular) return regularWeights(leaf.uv, boundaryMask(patch.texParam1));
    if (patch.texType == kPatchQuads) return bilinearWeights(leaf.uv);
    std::vector<double> w(20);
    tables_.patches->EvaluateBasisFaceVarying(handles_[index], uv.x, uv.y, w.data());
    w.resize(patch.texType == kPatchTriangles         ? 3
             : patch.texType == kPatchLoop            ? 12
             : patch.texType == kPatchGregoryTriangle ? 18
                                                      : 20);
    return w;
}

} // namespace relief

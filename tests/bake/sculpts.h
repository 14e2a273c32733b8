// Sculpts of known shape, and surfaces to bake them on.
#pragma once

#include <cmath>
#include <numbers>

#include "bake/bake.h"
#include "meshes.h"

namespace relief::test {

/// The flat square [0,4] x [-4,0] in y = 0; its limit surface has corners.
inline Cage squareGrid() {
    Cage cage = boundaryGrid();
    cage.boundaryRule = BoundaryRule::edgeAndCorner;
    return cage;
}

/// The grid of n * n quads over [0,1]^2 through `point(s, t)`, each quad two triangles.
template <typename Point>
TriangleMesh sheetThrough(std::uint32_t n, const Point& point) {
    TriangleMesh mesh;
    for (std::uint32_t y = 0; y <= n; ++y)
        for (std::uint32_t x = 0; x <= n; ++x) mesh.positions.emplace_back(point(double(x) / n, double(y) / n));
    for (std::uint32_t y = 0; y < n; ++y)
        for (std::uint32_t x = 0; x < n; ++x) {
            const std::uint32_t a = y * (n + 1) + x;
            for (const std::uint32_t i : {a, a + 1, a + n + 2, a, a + n + 2, a + n + 1}) mesh.indices.push_back(i);
        }
    return mesh;
}

/// Over squareGrid(): heights above it, x and z as there.
template <typename Height>
TriangleMesh hillsOverGrid(std::uint32_t n, const Height& height) {
    return sheetThrough(n, [&](double s, double t) { return dvec3(4 * s, height(4 * s, 4 * t), -4 * t); });
}

/// The triangles of a sheet whose middles lie outside of low < (x,-z) < high.
inline TriangleMesh withHole(TriangleMesh sheet, const dvec2& low, const dvec2& high) {
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < sheet.indices.size(); i += 3) {
        dvec3 middle(0);
        for (std::size_t k = 0; k < 3; ++k) middle += dvec3(sheet.positions[sheet.indices[i + k]]) / 3.0;
        const bool isInHole = middle.x > low.x && middle.x < high.x && -middle.z > low.y && -middle.z < high.y;
        if (!isInHole) kept.insert(kept.end(), &sheet.indices[i], &sheet.indices[i] + 3);
    }
    sheet.indices = std::move(kept);
    return sheet;
}

inline void append(TriangleMesh& mesh, const TriangleMesh& more) {
    const auto first = std::uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), more.positions.begin(), more.positions.end());
    for (const std::uint32_t index : more.indices) mesh.indices.push_back(first + index);
}

inline void turnOver(TriangleMesh& mesh, std::size_t firstTriangle = 0, std::size_t step = 1) {
    for (std::size_t i = firstTriangle; i < mesh.indices.size() / 3; i += step)
        std::swap(mesh.indices[3 * i + 1], mesh.indices[3 * i + 2]);
}

inline MeasuredSurface measured(const TriangleMesh& mesh) {
    return MeasuredSurface({mesh.positions, mesh.indices}, 20'000, TreeUse::lines);
}

/// A cage with everything that baking over its texture coordinates takes.
struct Baking {
    explicit Baking(const Cage& cage, const UvTexelOptions& options = {})
        : surface(buildSurface(cage, {})), reference(cage, SurfaceOptions()), texels(surface, reference, options),
          wrap(options.wrap) {}

    [[nodiscard]] BakedHeights bake(const MeasuredSurface& sculpt, const LineReach& reach,
                                    Facing facing = Facing::front) const {
        return bakeHeights(reference, sculpt, texels, {.lines = {.reach = reach, .facing = facing}});
    }
    [[nodiscard]] HeightMap mapOf(const BakedHeights& baked) const {
        return makeHeightMap(baked.width, baked.height, baked.heights, 0, 1, wrap);
    }

    Surface surface;
    ReferenceSurface reference;
    UvTexels texels;
    Wrap wrap;
};

} // namespace relief::test

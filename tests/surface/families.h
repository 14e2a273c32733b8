// Small cages, one or more of each kind that a promise must hold for.
#pragma once

#include <cmath>
#include <numbers>
#include <string>

#include "surface/surface.h"

namespace relief {

using Polygon = std::vector<std::uint32_t>;

inline Cage makeCage(std::vector<vec3> positions, const std::vector<Polygon>& polygons) {
    Cage cage;
    cage.positions = std::move(positions);
    for (const Polygon& polygon : polygons) {
        cage.faceSizes.push_back(std::uint32_t(polygon.size()));
        cage.corners.insert(cage.corners.end(), polygon.begin(), polygon.end());
    }
    return cage;
}

inline vec3 onCircle(int i, int n, float radius, float z) {
    const double angle = 2 * std::numbers::pi * i / n;
    return {radius * float(std::cos(angle)), radius * float(std::sin(angle)), z};
}

/// Smooth and different everywhere: keeps symmetric cages from hiding mistakes.
inline Cage bent(Cage cage) {
    for (vec3& p : cage.positions)
        p += vec3(0.11F * std::sin(2 * p.y + 1), 0.07F * std::sin(3 * p.z), 0.13F * p.x * p.y);
    return cage;
}

/// Texture coordinates that flow across all edges.
inline Cage withFlatTexCoords(Cage cage) {
    for (const vec3& p : cage.positions) cage.texCoords.emplace_back(0.3F * p.x + 0.1F * p.z, 0.4F * p.y - 0.2F * p.z);
    cage.texCorners = cage.corners;
    return cage;
}

inline Cage withCreases(Cage cage, const std::vector<std::uint32_t>& loop, float sharpness) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
        cage.creaseEdges.push_back(loop[i]);
        cage.creaseEdges.push_back(loop[(i + 1) % loop.size()]);
        cage.creaseSharpness.push_back(sharpness);
    }
    return cage;
}

inline Cage withSharpVertex(Cage cage, std::uint32_t vertex, float sharpness) {
    cage.sharpVertices.push_back(vertex);
    cage.vertexSharpness.push_back(sharpness);
    return cage;
}

/// Two n-gons and n quads; prism(4) is a cube, its top is vertices n..2n-1.
inline Cage prism(int n) {
    std::vector<vec3> positions;
    std::vector<Polygon> polygons(2);
    for (int i = 0; i < n; ++i) positions.push_back(onCircle(i, n, 1.2F, -0.8F));
    for (int i = 0; i < n; ++i) positions.push_back(onCircle(i, n, 1, 0.9F));
    for (std::uint32_t i = 0; i < std::uint32_t(n); ++i) {
        const std::uint32_t next = (i + 1) % n;
        polygons[0].insert(polygons[0].begin(), i);
        polygons[1].push_back(n + i);
        polygons.push_back({i, next, n + next, n + i});
    }
    return bent(makeCage(positions, polygons));
}

/// Two poles of valence n, 2n vertices of valence 3 between them, quads only.
inline Cage poles(int n) {
    std::vector<vec3> positions{{0, 0, 1.3F}, {0, 0, -1.1F}};
    std::vector<Polygon> polygons;
    for (int i = 0; i < 2 * n; ++i) positions.push_back(onCircle(i, 2 * n, 1.2F, i % 2 ? 0.35F : -0.35F));
    const auto ring = [&](int i) { return std::uint32_t(2 + (i + 2 * n) % (2 * n)); };
    for (int i = 0; i < n; ++i) {
        polygons.push_back({0, ring(2 * i - 1), ring(2 * i), ring(2 * i + 1)});
        polygons.push_back({1, ring(2 * i + 2), ring(2 * i + 1), ring(2 * i)});
    }
    return bent(makeCage(positions, polygons));
}

/// columns x rows quads of a wavy sheet; vertex (i,j) has index i + j (columns + 1).
inline Cage sheet(int columns, int rows) {
    std::vector<vec3> positions;
    std::vector<Polygon> polygons;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i)
            positions.emplace_back(i, j, 0.4 * std::sin(1.3 * i + 0.5) * std::cos(0.9 * j));
    for (int j = 0; j < rows; ++j) {
        for (int i = 0; i < columns; ++i) {
            const std::uint32_t a = i + j * (columns + 1), up = columns + 1;
            polygons.push_back({a, a + 1, a + 1 + up, a + up});
        }
    }
    return makeCage(positions, polygons);
}

/// The sheet with each quad cut in two triangles.
inline Cage triangleSheet(int columns, int rows) {
    const Cage quads = sheet(columns, rows);
    std::vector<Polygon> polygons;
    for (std::size_t c = 0; c < quads.corners.size(); c += 4) {
        const std::uint32_t* v = &quads.corners[c];
        polygons.push_back({v[0], v[1], v[2]});
        polygons.push_back({v[0], v[2], v[3]});
    }
    return makeCage(quads.positions, polygons);
}

/// A regular torus whose texture coordinates tear along one ring and one meridian.
inline Cage seamedTorus(int around, int across) {
    Cage cage;
    for (int j = 0; j < across; ++j) {
        for (int i = 0; i < around; ++i) {
            const vec3 r = onCircle(j, across, 0.5F, 0);
            cage.positions.push_back(onCircle(i, around, 1.2F + r.x, r.y));
        }
    }
    const auto position = [&](int i, int j) { return std::uint32_t(i % around + (j % across) * around); };
    const auto texCoord = [&](int i, int j) { return std::uint32_t(i + j * (around + 1)); };
    for (int j = 0; j <= across; ++j)
        for (int i = 0; i <= around; ++i)
            cage.texCoords.emplace_back((float(i) + 0.2F * std::sin(float(j))) / float(around),
                                        float(j) / float(across) + 0.02F * float(i * i));
    for (int j = 0; j < across; ++j) {
        for (int i = 0; i < around; ++i) {
            const int corners[4][2] = {{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}};
            for (const auto& c : corners) {
                cage.corners.push_back(position(c[0], c[1]));
                cage.texCorners.push_back(texCoord(c[0], c[1]));
            }
            cage.faceSizes.push_back(4);
        }
    }
    return bent(cage);
}

inline Cage icosahedron() {
    const float g = 1.618034F;
    const std::vector<vec3> positions{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    return bent(
        makeCage(positions, {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                             {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                             {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}));
}

/// n triangles around each of two poles.
inline Cage bipyramid(int n) {
    std::vector<vec3> positions{{0, 0, 1}, {0, 0, -1.2F}};
    std::vector<Polygon> polygons;
    for (int i = 0; i < n; ++i) positions.push_back(onCircle(i, n, 1.3F, 0.1F * float(i % 3)));
    for (int i = 0; i < n; ++i) {
        const std::uint32_t a = 2 + i, b = 2 + (i + 1) % n;
        polygons.push_back({0, a, b});
        polygons.push_back({1, b, a});
    }
    return bent(makeCage(positions, polygons));
}

/// Three quads on one edge.
inline Cage fins() {
    return makeCage({{0, 0, 0},
                     {0, 0, 1},
                     {1, 0, 0},
                     {1, 0.2F, 1},
                     {-0.5F, 1, 0},
                     {-0.5F, 1, 1.1F},
                     {-0.4F, -1, 0},
                     {-0.6F, -1, 0.9F}},
                    {{0, 2, 3, 1}, {0, 4, 5, 1}, {1, 7, 6, 0}});
}

/// Two sheets that touch in one vertex.
inline Cage bowTie() {
    Cage cage = sheet(2, 2), other = sheet(2, 2);
    for (vec3& p : other.positions) p += vec3(2, 2, 0.5F);
    const auto meeting = std::uint32_t(cage.positions.size() - 1), shift = std::uint32_t(cage.positions.size());
    other.positions[0] = cage.positions[meeting];
    cage.positions.insert(cage.positions.end(), other.positions.begin(), other.positions.end());
    for (const std::uint32_t corner : other.corners) cage.corners.push_back(corner == 0 ? meeting : shift + corner);
    cage.faceSizes.insert(cage.faceSizes.end(), other.faceSizes.begin(), other.faceSizes.end());
    return cage;
}

/// A sheet of two quads, the second wound the other way round.
inline Cage twistedPair() {
    return makeCage({{0, 0, 0}, {1, 0, 0.1F}, {1, 1, 0}, {0, 1, 0.2F}, {2, 0, 0.3F}, {2, 1, 0}},
                    {{0, 1, 2, 3}, {1, 2, 5, 4}});
}

/// Two pentagons and a quad side by side: an edge between n-gons, and a quad beside one.
inline Cage pentagons() {
    return makeCage({{0, 0, 0},
                     {1, 0, 0.2F},
                     {1, 1, 0},
                     {0.5F, 1.5F, 0.3F},
                     {0, 1, 0},
                     {2, -0.2F, 0},
                     {2.4F, 0.5F, 0.2F},
                     {2, 1.1F, 0},
                     {-1, 0, 0.2F},
                     {-1, 1, 0}},
                    {{0, 1, 2, 3, 4}, {5, 6, 7, 2, 1}, {8, 0, 4, 9}});
}

inline Cage withHoles(Cage cage, std::vector<std::uint32_t> holes) {
    cage.holes = std::move(holes);
    return cage;
}

inline Cage withBoundary(Cage cage, BoundaryRule rule) {
    cage.boundaryRule = rule;
    return cage;
}

inline Cage withTexBoundary(Cage cage, TexBoundaryRule rule) {
    cage.texBoundaryRule = rule;
    return cage;
}

inline Cage withChaikin(Cage cage) {
    cage.creaseMethod = CreaseMethod::chaikin;
    return cage;
}

struct Family {
    std::string name;
    Cage cage;
    Scheme scheme = Scheme::catmark;
};

inline std::vector<Family> catmarkFamilies() {
    const std::vector<std::uint32_t> top{4, 5, 6, 7};
    std::vector<Family> families{
        {"cube", withFlatTexCoords(prism(4))},
        {"creased cube", withFlatTexCoords(withCreases(prism(4), top, 10))},
        {"sharp-cornered cube", withSharpVertex(withSharpVertex(prism(4), 0, 10), 6, 1.4F)},
        {"semi-sharp cube", withCreases(prism(4), top, 1.7F)},
        {"cube sharper than the isolation", withCreases(prism(4), top, 4.5F)},
        {"chaikin cube", withChaikin(withCreases(withCreases(prism(4), top, 1.9F), {0, 4}, 1))},
        {"triangular prism", withFlatTexCoords(prism(3))},
        {"pentagonal prism", withFlatTexCoords(prism(5))},
        {"creased pentagonal prism", withCreases(prism(5), {5, 6, 7, 8, 9}, 10)},
        {"pentagons", withFlatTexCoords(pentagons())},
        {"sheet", withFlatTexCoords(sheet(4, 3))},
        {"sheet with sharp corners", withBoundary(sheet(4, 3), BoundaryRule::edgeAndCorner)},
        {"sheet without boundary", withBoundary(sheet(5, 4), BoundaryRule::none)},
        {"torus", seamedTorus(6, 4)},
        {"torus with linear texture boundaries", withTexBoundary(seamedTorus(6, 4), TexBoundaryRule::boundaries)},
        {"torus with linear texture", withTexBoundary(seamedTorus(6, 4), TexBoundaryRule::all)},
        {"torus with smooth texture", withTexBoundary(seamedTorus(6, 4), TexBoundaryRule::none)},
        {"torus with holes", withHoles(seamedTorus(6, 4), {0, 1, 13})},
        {"prism with a hole", withHoles(prism(5), {1})},
        {"fins", fins()},
        {"bow tie", bowTie()},
        {"twisted pair", twistedPair()},
    };
    for (const int n : {3, 5, 6, 7, 8, 9, 10, 11, 12})
        families.push_back({"valence " + std::to_string(n), withFlatTexCoords(poles(n))});
    return families;
}

inline std::vector<Family> otherFamilies() {
    return {
        {"loop icosahedron", withFlatTexCoords(icosahedron()), Scheme::loop},
        {"loop creased icosahedron", withCreases(icosahedron(), {0, 11, 5}, 10), Scheme::loop},
        {"loop semi-sharp icosahedron", withCreases(icosahedron(), {0, 11, 5}, 1.6F), Scheme::loop},
        {"loop sheet", withFlatTexCoords(triangleSheet(4, 3)), Scheme::loop},
        {"loop sheet with a hole", withHoles(triangleSheet(4, 4), {9}), Scheme::loop},
        {"loop valence 3", bipyramid(3), Scheme::loop},
        {"loop valence 4", bipyramid(4), Scheme::loop},
        {"loop valence 9", bipyramid(9), Scheme::loop},
        {"bilinear cube", withFlatTexCoords(prism(4)), Scheme::bilinear},
        {"bilinear prism", withFlatTexCoords(prism(5)), Scheme::bilinear},
        {"bilinear sheet", sheet(3, 2), Scheme::bilinear},
    };
}

inline std::vector<Family> allFamilies() {
    std::vector<Family> families = catmarkFamilies();
    for (Family& family : otherFamilies()) families.push_back(std::move(family));
    return families;
}

inline Bounds boundsOf(const Cage& cage) {
    Bounds bounds;
    for (const vec3& p : cage.positions) bounds.add(dvec3(p));
    return bounds;
}

/// The scale that tolerances are relative to.
inline double sizeOf(const Cage& cage) {
    const Bounds bounds = boundsOf(cage);
    const dvec3 sides = bounds.upper - bounds.lower;
    return std::max({sides.x, sides.y, sides.z});
}

} // namespace relief

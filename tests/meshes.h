// Small cages made in code, each named after what it stresses. Faces run counter-clockwise seen from outside, Y up.
#pragma once

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "cage/cage.h"

namespace relief::test {

using Indices = std::vector<std::uint32_t>;

inline double degreesBetween(const dvec3& a, const dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

/// Adds a face; texCorners are needed on all faces or on none.
inline void addFace(Cage& cage, const Indices& corners, const Indices& texCorners = {}) {
    cage.faceSizes.push_back(std::uint32_t(corners.size()));
    cage.corners.insert(cage.corners.end(), corners.begin(), corners.end());
    cage.texCorners.insert(cage.texCorners.end(), texCorners.begin(), texCorners.end());
}

inline void addCrease(Cage& cage, std::uint32_t a, std::uint32_t b, float sharpness) {
    cage.creaseEdges.insert(cage.creaseEdges.end(), {a, b});
    cage.creaseSharpness.push_back(sharpness);
}

inline void addSharpVertex(Cage& cage, std::uint32_t vertex, float sharpness) {
    cage.sharpVertices.push_back(vertex);
    cage.vertexSharpness.push_back(sharpness);
}

/// The point at `turns` of a circle round the Y axis, counter-clockwise seen from above.
inline vec3 onCircle(double turns, double radius, double y) {
    const double angle = 2 * std::numbers::pi * turns;
    return {radius * std::cos(angle), y, -radius * std::sin(angle)};
}

// --- closed, all quads -------------------------------------------------------------------------------------------

/// Eight extraordinary vertices of valence 3, no texture coordinates. Bits of a vertex index: 1 = +x, 2 = +y, 4 = +z.
inline Cage cube() {
    Cage cage;
    for (int i = 0; i < 8; ++i) cage.positions.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    const std::vector<Indices> faces = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (const Indices& face : faces) addFace(cage, face);
    return cage;
}

/// Gives every face a square of its own in an atlas: every edge is a seam.
inline Cage withIslands(Cage cage) {
    const int columns = int(std::ceil(std::sqrt(double(cage.faceCount()))));
    cage.texCoords.clear(), cage.texCorners.clear();
    for (std::size_t face = 0; face < cage.faceCount(); ++face) {
        const vec2 cell(face % columns, face / columns);
        for (std::uint32_t k = 0; k < cage.faceSizes[face]; ++k) {
            const vec3 p = onCircle((k + 0.5) / cage.faceSizes[face], 0.4, 0);
            cage.texCorners.push_back(std::uint32_t(cage.texCoords.size()));
            cage.texCoords.push_back((cell + 0.5f + vec2(p.x, -p.z)) / float(columns));
        }
    }
    return cage;
}

inline Cage cubeOfIslands() { return withIslands(cube()); }

/// A ring of semi-sharp edges round the top face.
inline Cage creasedCube(float sharpness = 2.5f) {
    Cage cage = cube();
    const Indices top = {2, 6, 7, 3};
    for (int k = 0; k < 4; ++k) addCrease(cage, top[k], top[(k + 1) % 4], sharpness);
    return cage;
}

/// Every edge infinitely sharp: the limit surface is the cube itself.
inline Cage hardCube() {
    Cage cage = cube();
    for (std::uint32_t a = 0; a < 8; ++a)
        for (const std::uint32_t bit : {1u, 2u, 4u})
            if ((a & bit) == 0) addCrease(cage, a, a | bit, 10);
    return cage;
}

/// One sharp edge alone: two darts, creases that end in a smooth vertex.
inline Cage dartCreasedCube(float sharpness = 10) {
    Cage cage = cube();
    addCrease(cage, 2, 3, sharpness);
    return cage;
}

/// One infinitely sharp and one semi-sharp vertex.
inline Cage cubeWithSharpVertices() {
    Cage cage = cube();
    addSharpVertex(cage, 7, 10);
    addSharpVertex(cage, 0, 1.5f);
    return cage;
}

/// Chaikin's rule averages sharpness along a crease, so it needs different neighbours.
inline Cage chaikinCreasedCube() {
    Cage cage = creasedCube(1);
    cage.creaseSharpness = {1, 2, 3, 4};
    cage.creaseMethod = CreaseMethod::chaikin;
    return cage;
}

/// Regular everywhere; one vertical and one horizontal texture seam.
inline Cage torusWithSeams(int around = 8, int across = 6, double radius = 2, double tube = 0.75) {
    Cage cage;
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            const double angle = 2 * std::numbers::pi * j / across;
            cage.positions.push_back(
                onCircle(double(i) / around, radius + tube * std::cos(angle), tube * std::sin(angle)));
        }
    for (int i = 0; i <= around; ++i)
        for (int j = 0; j <= across; ++j)
            cage.texCoords.emplace_back(float(i) / float(around), float(j) / float(across));
    const auto point = [&](int i, int j) { return std::uint32_t(i % around * across + j % across); };
    const auto tex = [&](int i, int j) { return std::uint32_t(i * (across + 1) + j); };
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j)
            addFace(cage, {point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)},
                    {tex(i, j), tex(i + 1, j), tex(i + 1, j + 1), tex(i, j + 1)});
    return cage;
}

/// The two poles have `valence` edges, the ring between them 3; one seam along the ring.
inline Cage poles(int valence) {
    Cage cage;
    const int count = 2 * valence;
    for (int k = 0; k < count; ++k) cage.positions.push_back(onCircle(double(k) / count, 1, k % 2 == 0 ? 0.2 : -0.2));
    const auto top = std::uint32_t(count), bottom = top + 1;
    cage.positions.emplace_back(0, 1, 0), cage.positions.emplace_back(0, -1, 0);
    for (int side = 0; side < 2; ++side)
        for (int k = 0; k <= count; ++k) {
            const vec3 p = k < count ? 0.23f * cage.positions[k] : vec3(0);
            cage.texCoords.emplace_back(0.25f + 0.5f * float(side) + p.x, 0.5f - p.z);
        }
    const auto ring = [&](int k) { return std::uint32_t((k + count) % count); };
    const std::uint32_t below = top + 1; // first texture coordinate of the lower side
    for (int k = 0; k < count; k += 2) {
        addFace(cage, {top, ring(k), ring(k + 1), ring(k + 2)}, {top, ring(k), ring(k + 1), ring(k + 2)});
        addFace(cage, {bottom, ring(k + 1), ring(k), ring(k - 1)},
                {below + top, below + ring(k + 1), below + ring(k), below + ring(k - 1)});
    }
    return cage;
}

/// The front half of the texture is the mirror image of the back half: its Jacobian changes sign without a seam.
inline Cage torusWithMirroredTexture() {
    Cage cage = torusWithSeams();
    for (vec2& st : cage.texCoords) st.x = st.x < 0.5f ? 2 * st.x : 2 - 2 * st.x;
    return cage;
}

/// Face 0 has all its texture coordinates in one point: the Jacobian is singular.
inline Cage torusWithCollapsedTexture() {
    Cage cage = torusWithSeams();
    for (int k = 1; k < 4; ++k) cage.texCorners[k] = cage.texCorners[0];
    return cage;
}

/// Vertices 2 and 3 at the same position: an edge without length.
inline Cage cubeWithCollapsedEdge() {
    Cage cage = cube();
    cage.positions[2] = cage.positions[3];
    return cage;
}

// --- closed, other faces -----------------------------------------------------------------------------------------

/// Two n-gons joined by n quads; the sides are one strip of the texture, the ends two discs.
inline Cage nGonPrism(int sides) {
    Cage cage;
    for (int level = 0; level < 2; ++level)
        for (int k = 0; k < sides; ++k) cage.positions.push_back(onCircle(double(k) / sides, 1, level - 0.5));
    for (int level = 0; level < 2; ++level)
        for (int k = 0; k <= sides; ++k)
            cage.texCoords.emplace_back(float(k) / float(sides), 0.5f + 0.5f * float(level));
    const auto discs = std::uint32_t(cage.texCoords.size());
    for (int level = 0; level < 2; ++level)
        for (int k = 0; k < sides; ++k) {
            const vec3 p = onCircle(double(k) / sides, 0.24, 0);
            cage.texCoords.emplace_back(0.25f + 0.5f * float(level) + p.x, 0.25f - p.z);
        }

    const auto n = std::uint32_t(sides);
    for (std::uint32_t k = 0; k < n; ++k)
        addFace(cage, {k, (k + 1) % n, n + (k + 1) % n, n + k}, {k, k + 1, n + 1 + k + 1, n + 1 + k});
    Indices bottom, bottomTex, top, topTex;
    for (std::uint32_t k = 0; k < n; ++k) {
        bottom.push_back(n - 1 - k), bottomTex.push_back(discs + n - 1 - k);
        top.push_back(n + k), topTex.push_back(discs + n + k);
    }
    addFace(cage, bottom, bottomTex);
    addFace(cage, top, topTex);
    return cage;
}

/// A pentagon below, five quads round, five triangles as the roof.
inline Cage mixedFaces() {
    Cage cage = nGonPrism(5);
    cage.texCoords.clear(), cage.texCorners.clear();
    cage.faceSizes.pop_back();
    cage.corners.resize(cage.corners.size() - 5);
    cage.positions.emplace_back(0, 1.25, 0);
    for (std::uint32_t k = 0; k < 5; ++k) addFace(cage, {5 + k, 5 + (k + 1) % 5, 10});
    return cage;
}

/// Triangles only, every vertex of valence 5.
inline Cage icosahedron() {
    Cage cage;
    const auto g = float(std::numbers::phi);
    cage.positions = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    const std::vector<Indices> faces = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                        {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                        {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                        {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (const Indices& face : faces) addFace(cage, face);
    return cage;
}

/// Each quad as two triangles, with its texture coordinates.
inline Cage triangulated(const Cage& quads) {
    Cage cage = quads;
    cage.faceSizes.clear(), cage.corners.clear(), cage.texCorners.clear();
    const auto pick = [](const Indices& from, std::size_t first, std::initializer_list<int> which) {
        Indices picked;
        for (const int k : which)
            if (!from.empty()) picked.push_back(from[first + k]);
        return picked;
    };
    for (std::size_t i = 0; i < quads.corners.size(); i += 4) {
        addFace(cage, pick(quads.corners, i, {0, 1, 2}), pick(quads.texCorners, i, {0, 1, 2}));
        addFace(cage, pick(quads.corners, i, {0, 2, 3}), pick(quads.texCorners, i, {0, 2, 3}));
    }
    return cage;
}

/// Triangles with every vertex regular (valence 6), with seams.
inline Cage triangleTorus() { return triangulated(torusWithSeams()); }

// --- open --------------------------------------------------------------------------------------------------------

/// Boundary all round, flat in y = 0, [0,columns] x [-rows,0], with texture coordinates 0..1 and no seam.
inline Cage boundaryGrid(int columns = 4, int rows = 4) {
    Cage cage;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) {
            cage.positions.emplace_back(i, 0, -j);
            cage.texCoords.emplace_back(float(i) / float(columns), float(j) / float(rows));
        }
    const auto at = [&](int i, int j) { return std::uint32_t(j * (columns + 1) + i); };
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const Indices face = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
            addFace(cage, face, face);
        }
    return cage;
}

/// The same grid bent into hills, with sharp corners (the other boundary rule).
inline Cage hillyGrid() {
    Cage cage = boundaryGrid(5, 5);
    for (vec3& p : cage.positions) p.y = 0.6f * std::sin(1.3f * p.x) * std::cos(1.1f * p.z);
    cage.boundaryRule = BoundaryRule::edgeAndCorner;
    return cage;
}

/// A crease that begins at the boundary and ends inside.
inline Cage dartCreasedGrid() {
    Cage cage = hillyGrid();
    addCrease(cage, 2, 8, 10);
    addCrease(cage, 8, 14, 3);
    return cage;
}

/// Faces that belong to the topology but are not drawn.
inline Cage torusWithHoles() {
    Cage cage = torusWithSeams();
    cage.holes = {0, 1, 20};
    return cage;
}

/// One face alone, of n corners.
inline Cage lonePolygon(int sides) {
    Cage cage;
    Indices face;
    for (int k = 0; k < sides; ++k) {
        const vec3 p = onCircle(double(k) / sides, 1, 0);
        cage.positions.push_back(p);
        cage.texCoords.emplace_back(0.5f + 0.5f * p.x, 0.5f - 0.5f * p.z);
        face.push_back(std::uint32_t(k));
    }
    addFace(cage, face, face);
    return cage;
}

// --- non-manifold ------------------------------------------------------------------------------------------------

/// Two cubes, the second moved by `offset`, sharing the vertices that coincide.
inline Cage twoCubes(const vec3& offset) {
    Cage cage = cube();
    const Cage second = cube();
    Indices moved;
    for (const vec3& p : second.positions) {
        const auto found = std::find(cage.positions.begin(), cage.positions.end(), p + offset);
        moved.push_back(std::uint32_t(found - cage.positions.begin()));
        if (found == cage.positions.end()) cage.positions.push_back(p + offset);
    }
    for (std::size_t i = 0; i < second.corners.size(); i += 4)
        addFace(cage, {moved[second.corners[i]], moved[second.corners[i + 1]], moved[second.corners[i + 2]],
                       moved[second.corners[i + 3]]});
    return cage;
}

/// Four faces meet in one edge.
inline Cage nonManifoldEdge() { return twoCubes({2, 2, 0}); }

/// Two closed surfaces meet in one vertex.
inline Cage nonManifoldVertex() { return twoCubes({2, 2, 2}); }

/// Two components and two named parts.
inline Cage separateParts() {
    Cage cage = twoCubes({4, 0, 0});
    cage.parts = {{.name = "left", .material = "stone", .firstFace = 0, .faceCount = 6},
                  {.name = "right", .material = "wood", .firstFace = 6, .faceCount = 6}};
    return cage;
}

/// A strip with half a twist: one edge has two faces that run it in the same direction.
inline Cage moebiusStrip(int length = 8) {
    Cage cage;
    for (int k = 0; k < length; ++k) {
        const double turns = double(k) / length;
        const double lean = std::numbers::pi * turns;
        for (const double side : {-0.5, 0.5})
            cage.positions.push_back(onCircle(turns, 2 + side * std::cos(lean), side * std::sin(lean)));
    }
    const auto n = std::uint32_t(2 * length);
    for (std::uint32_t k = 0; k + 2 < n; k += 2) addFace(cage, {k, k + 2, k + 3, k + 1});
    addFace(cage, {n - 2, 1, 0, n - 1});
    return cage;
}

// --- all of them -------------------------------------------------------------------------------------------------

struct NamedCage {
    std::string name;
    Cage cage;
};

/// Every family above, for tests that must hold for all cages; summarize() reports which are closed or all triangles.
inline std::vector<NamedCage> allCages() {
    std::vector<NamedCage> cages;
    const auto add = [&](std::string name, Cage cage) { cages.push_back({std::move(name), std::move(cage)}); };
    add("cube", cube());
    add("cubeOfIslands", cubeOfIslands());
    add("creasedCube", creasedCube());
    add("hardCube", hardCube());
    add("dartCreasedCube", dartCreasedCube());
    add("cubeWithSharpVertices", cubeWithSharpVertices());
    add("chaikinCreasedCube", chaikinCreasedCube());
    add("torusWithSeams", torusWithSeams());
    for (const int valence : {3, 5, 8, 17}) add(fmt::format("poles{}", valence), poles(valence));
    add("torusWithMirroredTexture", torusWithMirroredTexture());
    add("torusWithCollapsedTexture", torusWithCollapsedTexture());
    add("cubeWithCollapsedEdge", cubeWithCollapsedEdge());
    for (const int sides : {3, 5, 7}) add(fmt::format("nGonPrism{}", sides), nGonPrism(sides));
    add("mixedFaces", mixedFaces());
    add("icosahedron", icosahedron());
    add("triangleTorus", triangleTorus());
    add("boundaryGrid", boundaryGrid());
    add("hillyGrid", hillyGrid());
    add("dartCreasedGrid", dartCreasedGrid());
    add("torusWithHoles", torusWithHoles());
    for (const int sides : {3, 4, 6}) add(fmt::format("lonePolygon{}", sides), lonePolygon(sides));
    add("nonManifoldEdge", nonManifoldEdge());
    add("nonManifoldVertex", nonManifoldVertex());
    add("separateParts", separateParts());
    add("moebiusStrip", moebiusStrip());
    return cages;
}

} // namespace relief::test

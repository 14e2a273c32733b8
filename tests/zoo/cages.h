// The zoo's cages: all of tests/meshes.h, and what those lack, each named after what it stresses.
#pragma once

#include "meshes.h"
#include "surface/surface.h"

namespace relief::test {

struct ZooCage {
    std::string name;
    Cage cage;
    Scheme scheme = Scheme::catmark;
};

inline Cage cageOf(std::vector<vec3> positions, const std::vector<Indices>& faces) {
    Cage cage;
    cage.positions = std::move(positions);
    for (const Indices& face : faces) addFace(cage, face);
    return cage;
}

// --- textures ----------------------------------------------------------------------------------------------------

/// Islands turned, scaled, sheared and every other one mirrored: nothing about the map agrees across any edge.
inline Cage withScatteredIslands(Cage cage) {
    cage = withIslands(std::move(cage));
    std::size_t corner = 0;
    for (std::size_t face = 0; face < cage.faceCount(); ++face) {
        const vec3 axis = onCircle(0.13 * double(face), 0.3 + 0.25 * double(face % 4), 0);
        const float mirror = face % 2 == 0 ? 1.0f : -1.0f;
        for (std::uint32_t k = 0; k < cage.faceSizes[face]; ++k, ++corner) {
            const vec2 st = cage.texCoords[corner];
            cage.texCoords[corner] = {axis.x * st.x - mirror * axis.z * st.y + 0.1f * st.y,
                                      axis.z * st.x + mirror * axis.x * st.y};
        }
    }
    return cage;
}

inline Cage withTexBoundary(Cage cage, TexBoundaryRule rule) {
    cage.texBoundaryRule = rule;
    return cage;
}

// --- sharpness ---------------------------------------------------------------------------------------------------

/// Sharpness 0.7, 1.4, ... 4.9 and none by turns on the first edge of every face: creases, darts and crossings.
inline Cage withCreasesByTurns(Cage cage) {
    std::size_t corner = 0;
    for (std::size_t face = 0; face < cage.faceCount(); corner += cage.faceSizes[face++])
        if (face % 8 != 0) addCrease(cage, cage.corners[corner], cage.corners[corner + 1], 0.7f * float(face % 8));
    return cage;
}

/// A ring of creases round the n-gon on top of a prism.
inline Cage creasedPrism(int sides, float sharpness) {
    Cage cage = nGonPrism(sides);
    const auto n = std::uint32_t(sides);
    for (std::uint32_t k = 0; k < n; ++k) addCrease(cage, n + k, n + (k + 1) % n, sharpness);
    return cage;
}

/// Three sharp edges meet in one vertex, one of them half sharp.
inline Cage cornerOfCreases() {
    Cage cage = cube();
    addCrease(cage, 7, 6, 10), addCrease(cage, 7, 5, 10), addCrease(cage, 7, 3, 2.3f);
    return cage;
}

/// Sharp vertices of all kinds on a boundary and inside of it.
inline Cage gridWithSharpVertices() {
    Cage cage = hillyGrid();
    cage.boundaryRule = BoundaryRule::edgeOnly;
    addSharpVertex(cage, 0, 10), addSharpVertex(cage, 3, 1.5f), addSharpVertex(cage, 14, 10);
    return cage;
}

// --- boundaries --------------------------------------------------------------------------------------------------

/// Faces along the boundary only support the others.
inline Cage gridWithoutBoundary() {
    Cage cage = hillyGrid();
    cage.boundaryRule = BoundaryRule::none;
    return cage;
}

inline Cage withHoles(Cage cage, Indices holes) {
    cage.holes = std::move(holes);
    return cage;
}

// --- degenerate --------------------------------------------------------------------------------------------------

/// Vertices `which` all at the position of the first.
inline Cage withVerticesAtOnePosition(Cage cage, const Indices& which) {
    for (const std::uint32_t vertex : which) cage.positions[vertex] = cage.positions[which[0]];
    return cage;
}

/// Two faces glued back to back: four vertices of valence 2.
inline Cage pillow() { return cageOf({{0, 0, 0}, {2, 0, 0}, {2, 0.3f, 2}, {0, 0, 2}}, {{0, 3, 2, 1}, {0, 1, 2, 3}}); }

/// Two such faces without a common vertex: two sheets whose boundaries coincide.
inline Cage backToBack() {
    Cage cage = pillow();
    for (int k = 0; k < 4; ++k) cage.positions.push_back(cage.positions[k]);
    for (int k = 4; k < 8; ++k) cage.corners[k] += 4;
    return cage;
}

// --- non-manifold ------------------------------------------------------------------------------------------------

/// `pages` quads on one edge, some of them turned over.
inline Cage book(int pages) {
    Cage cage;
    cage.positions = {{0, 0, 0}, {0, 1, 0.1f}};
    for (int k = 0; k < pages; ++k) {
        const auto first = std::uint32_t(cage.positions.size());
        cage.positions.push_back(onCircle(double(k) / pages, 1, 0));
        cage.positions.push_back(onCircle(double(k) / pages, 1.3, 1));
        addFace(cage, k % 3 == 2 ? Indices{1, first + 1, first, 0} : Indices{0, first, first + 1, 1});
    }
    return cage;
}

/// Two quads, the second wound the other way round.
inline Cage twistedPair() {
    return cageOf({{0, 0, 0}, {1, 0, 0.1f}, {1, 1, 0}, {0, 1, 0.2f}, {2, 0, 0.3f}, {2, 1, 0}},
                  {{0, 1, 2, 3}, {1, 2, 5, 4}});
}

// --- triangles ---------------------------------------------------------------------------------------------------

/// n triangles round each of two poles.
inline Cage bipyramid(int n) {
    Cage cage;
    cage.positions = {{0, 1, 0}, {0, -1.2f, 0}};
    for (int k = 0; k < n; ++k) cage.positions.push_back(onCircle(double(k) / n, 1.3, 0.1 * (k % 3)));
    for (int k = 0; k < n; ++k) {
        const auto a = std::uint32_t(2 + k), b = std::uint32_t(2 + (k + 1) % n);
        addFace(cage, {0, a, b});
        addFace(cage, {1, b, a});
    }
    return cage;
}

// --- all of them -------------------------------------------------------------------------------------------------

inline void addLoopCages(std::vector<ZooCage>& cages) {
    const auto add = [&](std::string name, Cage cage) {
        cages.push_back({"loop " + std::move(name), std::move(cage), Scheme::loop});
    };
    for (NamedCage& named : allCages())
        if (named.cage.isAllTriangles()) add(named.name, std::move(named.cage));
    for (const int valence : {3, 4, 9, 33, 64}) add(fmt::format("bipyramid{}", valence), bipyramid(valence));
    add("scatteredIslands", withScatteredIslands(icosahedron()));
    add("creasesByTurns", withCreasesByTurns(icosahedron()));
    add("sheet", triangulated(hillyGrid()));
    add("sheetWithHoles", withHoles(triangulated(boundaryGrid()), {9, 10, 20}));
    add("nonManifoldEdge", triangulated(nonManifoldEdge()));
    add("nonManifoldVertex", triangulated(nonManifoldVertex()));
    add("collapsedFace", withVerticesAtOnePosition(icosahedron(), {0, 11, 5}));
    add("collapsedEdge", triangulated(cubeWithCollapsedEdge()));
}

inline void addBilinearCages(std::vector<ZooCage>& cages) {
    const auto add = [&](std::string name, Cage cage) {
        cages.push_back({"bilinear " + std::move(name), std::move(cage), Scheme::bilinear});
    };
    add("cubeOfIslands", cubeOfIslands());
    add("nGonPrism5", nGonPrism(5));
    add("hillyGrid", hillyGrid());
    add("torusWithHoles", torusWithHoles());
    add("nonManifoldEdge", nonManifoldEdge());
}

inline std::vector<ZooCage> zooCages() {
    std::vector<ZooCage> cages;
    const auto add = [&](std::string name, Cage cage) { cages.push_back({std::move(name), std::move(cage)}); };
    for (NamedCage& named : allCages()) add(named.name, std::move(named.cage));
    add("cubeOfScatteredIslands", withScatteredIslands(cube()));
    add("torusOfScatteredIslands", withScatteredIslands(torusWithSeams(6, 4)));
    add("prismOfScatteredIslands", withScatteredIslands(nGonPrism(5)));
    add("torusWithSmoothTexture", withTexBoundary(torusWithSeams(), TexBoundaryRule::none));
    add("torusWithLinearTexture", withTexBoundary(torusWithSeams(), TexBoundaryRule::all));
    for (const int valence : {4, 6, 12, 33, 64}) add(fmt::format("poles{}", valence), poles(valence));
    for (const int sides : {4, 12, 64}) add(fmt::format("nGonPrism{}", sides), nGonPrism(sides));
    add("lonePolygon64", lonePolygon(64));
    for (const float sharpness : {0.5f, 1.0f, 4.5f, 10.0f})
        add(fmt::format("creasedCube{}", sharpness), creasedCube(sharpness));
    add("dartCreasedCube1.5", dartCreasedCube(1.5f));
    add("cornerOfCreases", cornerOfCreases());
    add("torusWithCreasesByTurns", withCreasesByTurns(torusWithSeams()));
    add("mixedFacesWithCreasesByTurns", withCreasesByTurns(mixedFaces()));
    add("creasedPrism", creasedPrism(5, 10));
    add("halfSharpPrism", creasedPrism(7, 1.7f));
    add("creasedIslands", withCreasesByTurns(withScatteredIslands(cube())));
    add("gridWithSharpVertices", gridWithSharpVertices());
    add("gridWithoutBoundary", gridWithoutBoundary());
    add("gridWithHoles", withHoles(boundaryGrid(5, 5), {12, 13, 6}));
    add("prismWithHoles", withHoles(nGonPrism(5), {1, 6}));
    add("cubeWithCollapsedFace", withVerticesAtOnePosition(cubeOfIslands(), {2, 6, 7, 3}));
    add("cubeWithTwoCornersOfAFaceInOne", withVerticesAtOnePosition(cube(), {2, 7}));
    add("prismWithCollapsedPolygon", withVerticesAtOnePosition(nGonPrism(6), {6, 7, 8, 9, 10, 11}));
    add("pillow", pillow());
    add("backToBack", backToBack());
    add("cubesGluedFaceToFace", twoCubes({2, 0, 0}));
    add("book3", book(3));
    add("book8", book(8));
    add("twistedPair", twistedPair());
    addLoopCages(cages);
    addBilinearCages(cages);
    return cages;
}

} // namespace relief::test

// Cages, one or more of each kind that a promise about surfaces must hold for.
#pragma once

#include <cmath>
#include <string>

#include "meshes.h"
#include "surface/surface.h"

namespace relief {

using Polygon = std::vector<std::uint32_t>;
using test::degreesBetween;

inline Cage makeCage(std::vector<vec3> positions, const std::vector<Polygon>& polygons) {
    Cage cage;
    cage.positions = std::move(positions);
    for (const Polygon& polygon : polygons) test::addFace(cage, polygon);
    return cage;
}

/// Smooth and different everywhere: keeps symmetric cages from hiding mistakes.
inline Cage bent(Cage cage) {
    for (vec3& p : cage.positions)
        p += vec3(0.11F * std::sin(2 * p.y + 1), 0.07F * std::sin(3 * p.z) + 0.13F * p.x * p.z, 0.09F * p.x * p.y);
    return cage;
}

inline Cage withoutTexCoords(Cage cage) {
    cage.texCoords.clear(), cage.texCorners.clear();
    return cage;
}

/// Texture coordinates that flow across all edges.
inline Cage withFlatTexCoords(Cage cage) {
    cage.texCoords.clear();
    for (const vec3& p : cage.positions) cage.texCoords.emplace_back(0.3F * p.x + 0.1F * p.z, 0.4F * p.y - 0.2F * p.z);
    cage.texCorners = cage.corners;
    return cage;
}

inline Cage withCreases(Cage cage, const std::vector<std::uint32_t>& loop, float sharpness) {
    for (std::size_t i = 0; i < loop.size(); ++i)
        test::addCrease(cage, loop[i], loop[(i + 1) % loop.size()], sharpness);
    return cage;
}

inline Cage withSharpVertex(Cage cage, std::uint32_t vertex, float sharpness) {
    test::addSharpVertex(cage, vertex, sharpness);
    return cage;
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

/// n quads, then two n-gons; vertices n..2n-1 are the top. prism(4) is a cube.
inline Cage prism(int n) { return bent(withoutTexCoords(test::nGonPrism(n))); }

inline Cage poles(int n) { return bent(withoutTexCoords(test::poles(n))); }

inline Cage sheet(int columns, int rows) { return bent(withoutTexCoords(test::boundaryGrid(columns, rows))); }

inline Cage icosahedron() { return bent(test::icosahedron()); }

/// n triangles around each of two poles.
inline Cage bipyramid(int n) {
    std::vector<vec3> positions{{0, 1, 0}, {0, -1.2F, 0}};
    std::vector<Polygon> polygons;
    for (int i = 0; i < n; ++i) positions.push_back(test::onCircle(double(i) / n, 1.3, 0.1 * (i % 3)));
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

/// Two quads, the second wound the other way round.
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

struct Family {
    std::string name;
    Cage cage;
    Scheme scheme = Scheme::catmark;
};

inline std::vector<Family> catmarkFamilies() {
    const std::vector<std::uint32_t> top{4, 5, 6, 7};
    const Cage torus = bent(test::torusWithSeams(6, 4));
    std::vector<Family> families{
        {"flat-textured cube", withFlatTexCoords(prism(4))},
        {"flat-textured creased cube", withFlatTexCoords(withCreases(prism(4), top, 10))},
        {"semi-sharp cube", withCreases(prism(4), top, 1.7F)},
        {"sharper cube", withCreases(prism(4), top, 4.5F)},
        {"chaikin cube", withChaikin(withCreases(withCreases(prism(4), top, 1.9F), {0, 4}, 1))},
        {"flat-textured prism", withFlatTexCoords(prism(5))},
        {"creased prism", withCreases(prism(5), {5, 6, 7, 8, 9}, 10)},
        {"prism with a hole", withHoles(prism(5), {6})},
        {"pentagons", withFlatTexCoords(pentagons())},
        {"sheet without boundary", withBoundary(sheet(5, 4), BoundaryRule::none)},
        {"torus with smooth texture", withTexBoundary(torus, TexBoundaryRule::none)},
        {"torus with kept texture corners", withTexBoundary(torus, TexBoundaryRule::cornersOnly)},
        {"torus with spread texture corners", withTexBoundary(torus, TexBoundaryRule::cornersPlus2)},
        {"torus with linear texture boundaries", withTexBoundary(torus, TexBoundaryRule::boundaries)},
        {"torus with linear texture", withTexBoundary(torus, TexBoundaryRule::all)},
        {"fins", fins()},
        {"twisted pair", twistedPair()},
    };
    for (test::NamedCage& named : test::allCages()) families.push_back({named.name, bent(std::move(named.cage))});
    for (const int n : {4, 6, 7, 9, 10, 11, 12})
        families.push_back({"poles of " + std::to_string(n), withFlatTexCoords(poles(n))});
    return families;
}

inline std::vector<Family> otherFamilies() {
    const Cage triangles = test::triangulated(test::boundaryGrid(4, 3));
    return {
        {"loop icosahedron", withFlatTexCoords(icosahedron()), Scheme::loop},
        {"loop creased icosahedron", withCreases(icosahedron(), {0, 11, 5}, 10), Scheme::loop},
        {"loop semi-sharp icosahedron", withCreases(icosahedron(), {0, 11, 5}, 1.6F), Scheme::loop},
        {"loop sharper icosahedron", withCreases(icosahedron(), {0, 11, 5}, 4.5F), Scheme::loop},
        {"loop torus with seams", bent(test::triangleTorus()), Scheme::loop},
        {"loop sheet", bent(triangles), Scheme::loop},
        {"loop sheet with a hole", withHoles(bent(triangles), {9}), Scheme::loop},
        {"loop valence 3", bipyramid(3), Scheme::loop},
        {"loop valence 4", bipyramid(4), Scheme::loop},
        {"loop valence 9", bipyramid(9), Scheme::loop},
        {"bilinear cube", withFlatTexCoords(prism(4)), Scheme::bilinear},
        {"bilinear prism", bent(test::nGonPrism(5)), Scheme::bilinear},
        {"bilinear sheet", sheet(3, 2), Scheme::bilinear},
    };
}

inline std::vector<Family> allFamilies() {
    std::vector<Family> families = catmarkFamilies();
    for (Family& family : otherFamilies()) families.push_back(std::move(family));
    return families;
}

inline Bounds boundsOf(const Cage& cage) { return computeBounds(cage.positions); }

/// What tolerances are relative to.
inline double sizeOf(const Cage& cage) { return boundsOf(cage).longestSide(); }

/// OpenSubdiv's limit masks along a boundary of the texture have weights in single precision.
inline bool hasTexBoundary(const Cage& cage) {
    const CageSummary summary = summarize(cage);
    return summary.seamEdgeCount + summary.boundaryEdgeCount > 0;
}

} // namespace relief

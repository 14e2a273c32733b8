// Straight corners of faces on the device: normals and displaced points against the reference, on all paths.
#include <map>
#include <random>

#include "device.h"
#include "meshes.h"

namespace relief::test {
namespace {

class StraightCorners : public OnDevice {};

/// Compiles its shaders once for all tests.
Capturer& capturer() {
    static Capturer instance(device());
    return instance;
}

/// Rough hills on a grid of quads.
Cage roughGrid(int columns, int rows, std::uint32_t seed) {
    Cage cage = boundaryGrid(columns, rows);
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> rough(-0.15F, 0.15F);
    for (vec3& p : cage.positions) p += vec3(rough(random), rough(random), rough(random));
    return cage;
}

/// A prism whose two rims are infinitely sharp: each cap lies alone in the corners of its rim.
Cage creasedPrism(int sides) {
    Cage cage = nGonPrism(sides);
    for (std::uint32_t i = 0; i < std::uint32_t(sides); ++i)
        for (const std::uint32_t rim : {0u, std::uint32_t(sides)})
            addCrease(cage, rim + i, rim + (i + 1) % std::uint32_t(sides), 10);
    return cage;
}

std::vector<SampleQuery> cornerQueries(const Surface& surface) {
    std::vector<SampleQuery> queries;
    for (std::uint32_t face = 0; face < surface.faces.size(); ++face)
        for (int corner = 0; corner < surface.sideCount; ++corner)
            if (surface.faces[face].root != kNoPatch)
                queries.push_back({face, vec2(sidePoint(surface.sideCount, corner, 0))});
    return queries;
}

/// The largest angle between the device's limit normals in corners and the reference's.
double worstCornerNormal(const Cage& cage, const SurfaceOptions& options) {
    const Surface surface = buildSurface(cage, options);
    const ReferenceSurface reference(cage, options);
    const SurfaceModel model(device(), {.surface = &surface, .cagePositions = cage.positions});
    const std::vector<SampleQuery> queries = cornerQueries(surface);
    const std::vector<SampleResult> results = sampler().sample(model, queries, {});
    double worst = 0;
    for (std::size_t i = 0; i < queries.size(); ++i)
        worst = std::max(
            worst, degreesBetween(reference.normal(int(queries[i].face), dvec2(queries[i].uv)), dvec3(results[i].n)));
    return worst;
}

// Exact caps take differences of the points around them: after ten levels those are a thousandth of a face apart, and
// the tangents of such a corner nearly parallel.
TEST_F(StraightCorners, haveTheReferencesNormals) {
    for (const int isolation : {0, 3, 6, 10})
        for (std::uint32_t seed = 0; seed < 4; ++seed) {
            const Cage quads = roughGrid(1 + int(seed % 3), 1 + int(seed / 2), seed);
            SurfaceOptions options{.isolation = isolation};
            const double most = isolation == 10 ? 1 : 0.1;
            EXPECT_LT(worstCornerNormal(quads, options), most) << seed << " at " << isolation;
            options.scheme = Scheme::loop;
            EXPECT_LT(worstCornerNormal(triangulated(quads), options), most) << seed << " at " << isolation;
        }
    for (int sides = 3; sides <= 16; ++sides) EXPECT_LT(worstCornerNormal(creasedPrism(sides), {}), 0.1) << sides;
}

// Around a vertex of two faces both tangents vanish.
TEST_F(StraightCorners, ofTwoFacesAroundAVertexHaveTheReferencesNormals) {
    Cage cage;
    cage.positions = {{0, 0.1F, 0}, {-1, 0, 0}, {1, 0.2F, 0}, {0, 0, -1}, {0, 0.3F, 1}};
    addFace(cage, {0, 1, 4, 2});
    addFace(cage, {0, 2, 3, 1});
    EXPECT_LT(worstCornerNormal(cage, {}), 0.5);
}

// In the middle of a cap of 1000 corners the tangents of one face are a third of a degree apart.
TEST_F(StraightCorners, ofManyFacesAroundAVertexHaveTheReferencesNormals) {
    EXPECT_LT(worstCornerNormal(nGonPrism(1000), {}), 1);
}

// Where a face is a hundredth of the object, differences of its corner's rounded control points would be noise.
TEST_F(StraightCorners, areAsExactOnSmallFaces) { EXPECT_LT(worstCornerNormal(roughGrid(100, 100, 5), {}), 0.5); }

/// A map that lifts everything by 1.
HeightMap plateau() { return makeHeightMap(2, 2, {1, 1, 1, 1}, 0, 1, Wrap::clamp); }

/// One square in the plane y = 0, turned by `turn` radians: rounding differs from turn to turn.
Cage turnedSquare(float turn) {
    Cage cage = boundaryGrid(1, 1);
    for (vec3& p : cage.positions)
        p = 1.7F * vec3(std::cos(turn) * p.x - std::sin(turn) * p.z, 0, std::sin(turn) * p.x + std::cos(turn) * p.z);
    return cage;
}

// A sheet moves along its normal: no corner may go the other way.
TEST_F(StraightCorners, ofALiftedSheetAreLifted) {
    const HeightMap map = plateau();
    for (int k = 0; k < 8; ++k) {
        const Cage cage = turnedSquare(0.3F * float(k));
        const Surface surface = buildSurface(cage, {});
        const SurfaceModel model(device(), {.surface = &surface, .cagePositions = cage.positions, .height = &map});
        const EdgeRates rates{uniformRates(model, 4), Spacing::equal, std::vector<float>(model.cornerFlags.size(), 0)};
        for (const Path path : {Path::tessellation, Path::grid, Path::dice}) {
            if (path == Path::tessellation && !device().traits().hasTessellation) continue;
            const CapturedMesh mesh = capturer().capture(model, {.path = path, .rate = 4}, rates);
            ASSERT_GT(mesh.positions.size(), 0u);
            for (const vec3& p : mesh.positions) EXPECT_NEAR(p.y, 1, 1e-5) << "path " << int(path) << " turn " << k;
        }
    }
}

/// Where the points of the upper rim of a creased prism go when everything is lifted, by their angle around the axis.
std::map<double, dvec3> rimDirections(int sides, Path path) {
    const Cage cage = creasedPrism(sides);
    const Surface surface = buildSurface(cage, {.isolation = 3});
    const HeightMap map = plateau();
    const SurfaceModel flat(device(), {.surface = &surface, .cagePositions = cage.positions});
    const SurfaceModel lifted(device(), {.surface = &surface, .cagePositions = cage.positions, .height = &map});
    const EdgeRates rates{uniformRates(flat, 16), Spacing::equal, std::vector<float>(flat.cornerFlags.size(), 0)};
    const CapturedMesh from = capturer().capture(flat, {.path = path}, rates),
                       to = capturer().capture(lifted, {.path = path}, rates);
    const auto isLower = [](const vec3& a, const vec3& b) { return a.y < b.y; };
    const float top = std::ranges::max_element(from.positions, isLower)->y;
    std::map<double, dvec3> directions;
    for (std::size_t i = 0; i < from.positions.size(); ++i) {
        const vec3 p = from.positions[i];
        const dvec3 direction(to.positions[i] - p);
        if (top - p.y < 1e-4F && glm::length(vec2(direction.x, direction.z)) > 0.1F)
            directions[std::atan2(p.z, p.x)] = direction;
    }
    return directions;
}

// A corner has one face of the cap and two of the sides; an edge has one of each. Counted by face, corners would stick
// out.
TEST_F(StraightCorners, ofARimMoveTheWayItsEdgesDo) {
    for (const int sides : {3, 4, 5, 8})
        for (const Path path : {Path::grid, Path::dice}) {
            const auto directions = rimDirections(sides, path);
            ASSERT_GE(directions.size(), std::size_t(16 * sides));
            dvec3 last = directions.rbegin()->second;
            for (const auto& [angle, direction] : directions) {
                EXPECT_LT(degreesBetween(last, direction), 11) << sides << " sides, at " << glm::degrees(angle);
                last = direction;
            }
        }
}

} // namespace
} // namespace relief::test

// Cages posed on the device: stencils, rigs, bounds and stretching heights against the double-precision reference.
#include <filesystem>
#include <random>

#include "frame/device.h"
#include "meshes.h"
#include "pose/pose.h"
#include "pose/poses.h"
#include "shared/displacement.h"
#include "shared/pose.h"
#include "support.h"

namespace relief::test {
namespace {

/// A screw along Y that leaves no symmetry, growing with `amount`.
std::vector<vec3> twisted(const Cage& cage, double amount) {
    std::vector<vec3> positions;
    for (const vec3& p : cage.positions) {
        const double angle = amount * (0.9 * p.y + 0.17 * p.x + 0.3), c = std::cos(angle), s = std::sin(angle);
        positions.emplace_back(c * p.x - s * p.z, 1.13 * p.y + 0.07 * amount * p.x * p.z, s * p.x + c * p.z);
    }
    return positions;
}

std::vector<SampleQuery> randomQueries(const Surface& surface, int count) {
    std::mt19937 random(11);
    std::uniform_int_distribution<std::uint32_t> faces(0, std::uint32_t(surface.faces.size() - 1));
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<SampleQuery> queries;
    while (queries.size() < std::size_t(count)) {
        SampleQuery q{faces(random), {unit(random), unit(random)}};
        if (surface.sideCount == 3 && q.uv.x + q.uv.y > 1) q.uv = 1.0f - q.uv;
        if (surface.faces[q.face].root != kNoPatch) queries.push_back(q);
    }
    return queries;
}

double longestSide(std::span<const vec3> positions) {
    Bounds bounds;
    for (const vec3& p : positions) bounds.add(dvec3(p));
    return bounds.longestSide();
}

double distance(const dvec3& a, const dvec3& b) { return glm::length(a - b); }

double degrees(const dvec3& a, const dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

// --- stencils ------------------------------------------------------------------------------------------------------

/// The rows as the device sums them, in double precision.
std::vector<dvec3> blended(const StencilBlocks& blocks, const Stencils& stencils, std::span<const vec3> cage) {
    std::vector<dvec3> rows(stencils.rowCount(), dvec3(0));
    for (std::size_t block = 0; block < blocks.blockCount(); ++block)
        for (std::size_t lane = 0; lane < kBlockRows; ++lane) {
            const std::uint32_t row = blocks.targets[kBlockRows * block + lane];
            if (row == kNoPatch) continue;
            for (std::size_t e = blocks.firsts[block]; e < blocks.firsts[block + 1]; ++e) {
                const std::int32_t weight = blocks.weights[4 * (e / 4 * kBlockRows + lane) + e % 4];
                rows[row] += std::ldexp(weight, stencils.scales[row]) * dvec3(cage[blocks.entries[e]]);
            }
        }
    return rows;
}

TEST(StencilBlocks, holdEveryRowOnceWithItsWeights) {
    for (const NamedCage& named : allCages()) {
        const Surface surface = buildSurface(named.cage, {.isolation = 4});
        const StencilBlocks blocks = stencilBlocks(surface.stencils);
        const std::vector<dvec3> points = refinePoints(surface, named.cage.positions);
        std::vector<int> seen(surface.stencils.rowCount());
        for (const std::uint32_t row : blocks.targets)
            if (row != kNoPatch) ++seen[row];
        EXPECT_TRUE(std::ranges::all_of(seen, [](int count) { return count == 1; })) << named.name;
        const std::vector<dvec3> rows = blended(blocks, surface.stencils, named.cage.positions);
        for (std::size_t row = 0; row < rows.size(); ++row)
            ASSERT_LT(distance(rows[row], points[surface.controlPointCount + row]), 2e-6)
                << named.name << " row " << row;
    }
}

TEST(StencilBlocks, ofOneSizeLieTogetherInEights) {
    const Surface surface = buildSurface(poles(9), {.isolation = 4});
    const StencilBlocks blocks = stencilBlocks(surface.stencils);
    std::uint32_t block = 0, before = 0;
    for (const StencilClass& c : blocks.classes) {
        EXPECT_EQ(c.firstBlock, block);
        EXPECT_GT(c.entryCount, before);
        EXPECT_EQ(c.entryCount % kEntriesTogether, 0u);
        for (std::uint32_t i = 0; i < c.blockCount; ++i, ++block)
            EXPECT_EQ(blocks.firsts[block + 1] - blocks.firsts[block], c.entryCount);
        before = c.entryCount;
    }
    EXPECT_EQ(block, blocks.blockCount());
}

TEST(StencilBlocks, ofASizeThatFewHaveGetTheNextSize) {
    const Surface surface = buildSurface(poles(9), {.isolation = 4});
    const StencilBlocks blocks = stencilBlocks(surface.stencils);
    ASSERT_LT(blocks.blockCount(), 1000u);
    // One size for all that straight code is made for, and the sizes of larger ones.
    for (std::size_t i = 1; i < blocks.classes.size(); ++i) EXPECT_GT(blocks.classes[i].entryCount, 32u);
    ASSERT_FALSE(blocks.classes.empty());
}

// --- poses ---------------------------------------------------------------------------------------------------------

class Poses : public OnDevice {};

struct Case {
    std::string name;
    Cage cage;
    SurfaceOptions options;
};

std::vector<Case> allCases() {
    std::vector<Case> all;
    for (NamedCage& named : allCages()) {
        if (named.cage.isAllTriangles()) all.push_back({named.name + " loop", named.cage, {Scheme::loop, 3}});
        all.push_back({named.name, std::move(named.cage), {Scheme::catmark, 3}});
    }
    for (const char* name : {"bigguy.obj", "car.obj"})
        if (const std::string path = productionFolder() + "/" + name; std::filesystem::exists(path))
            all.push_back({name, readCage(path), {}});
    return all;
}

// OpenSubdiv's own tolerance is 5e-5 of the box for points; single precision leaves less.
TEST_F(Poses, giveTheLimitPointsOfThePosedCage) {
    const HeightMap map = sineMap(64, 0.02);
    double worstPoint = 0, worstDisplaced = 0;
    for (const Case& c : allCases()) {
        const Surface surface = buildSurface(c.cage, c.options);
        ReferenceSurface reference(c.cage, c.options);
        SurfaceModel model(device(), {.surface = &surface, .cagePositions = c.cage.positions, .height = &map});
        Poser poser(device(), model, {.surface = &surface});
        const std::vector<SampleQuery> queries = randomQueries(surface, 100);
        for (const double amount : {0.3, 0.8}) {
            const std::vector<vec3> positions = twisted(c.cage, amount * 2 / longestSide(c.cage.positions));
            const double side = longestSide(positions);
            poser.pose(poseOf(positions));
            reference.pose(positions);
            const std::vector<SampleResult> results = sampler().sample(model, queries);
            for (std::size_t i = 0; i < queries.size(); ++i) {
                const DisplacedFrame f = displacedFrame(reference, &map, int(queries[i].face), dvec2(queries[i].uv));
                worstPoint = std::max(worstPoint, distance(f.limit.p, results[i].p) / side);
                ASSERT_LT(distance(f.limit.p, results[i].p), 2e-6 * side) << c.name << " face " << queries[i].face;
                const double area = glm::length(glm::cross(f.limit.pu, f.limit.pv)) / (side * side);
                if (area < 1e-4) continue;
                worstDisplaced = std::max(worstDisplaced, distance(f.q, results[i].q) / side);
                EXPECT_LT(distance(f.q, results[i].q), 5e-5 * side) << c.name << " face " << queries[i].face;
                EXPECT_TRUE(poser.bounds().lower.x <= f.q.x && f.q.x <= poser.bounds().upper.x) << c.name;
            }
        }
    }
    RecordProperty("worstPoint", fmt::format("{}", worstPoint));
    RecordProperty("worstDisplaced", fmt::format("{}", worstDisplaced));
}

TEST_F(Poses, atRestAreTheModelsOwnPoints) {
    for (const NamedCage& named : {NamedCage{"poles", poles(7)}, NamedCage{"mixed", mixedFaces()}}) {
        const Surface surface = buildSurface(named.cage, {.isolation = 3});
        SurfaceModel model(device(), {.surface = &surface, .cagePositions = named.cage.positions});
        const std::vector<SampleQuery> queries = randomQueries(surface, 50);
        const std::vector<SampleResult> before = sampler().sample(model, queries);
        Poser poser(device(), model, {.surface = &surface});
        poser.pose(poseOf(named.cage.positions));
        const std::vector<SampleResult> after = sampler().sample(model, queries);
        for (std::size_t i = 0; i < queries.size(); ++i)
            EXPECT_LT(distance(dvec3(before[i].p), after[i].p), 2e-6) << named.name;
    }
}

TEST_F(Poses, areTheSameBitsWhateverCameBefore) {
    const Cage cage = torusWithSeams();
    const Surface surface = buildSurface(cage, {});
    SurfaceModel model(device(), {.surface = &surface, .cagePositions = cage.positions});
    Poser poser(device(), model, {.surface = &surface, .keepsBefore = true});
    const std::vector<SampleQuery> queries = randomQueries(surface, 50);
    const Pose one = poseOf(twisted(cage, 0.4)), other = poseOf(twisted(cage, 1.1));
    poser.pose(one, &other);
    const std::vector<SampleResult> first = sampler().sample(model, queries);
    poser.pose(other, &one);
    poser.pose(one, &one);
    const std::vector<SampleResult> again = sampler().sample(model, queries);
    for (std::size_t i = 0; i < queries.size(); ++i) EXPECT_EQ(first[i].q, again[i].q);
}

TEST_F(Poses, keepEveryFaceInItsBox) {
    const HeightMap map = sineMap(64, 0.1);
    for (const NamedCage& named : allCages()) {
        const SurfaceOptions options{.isolation = 3};
        const Surface surface = buildSurface(named.cage, options);
        ReferenceSurface reference(named.cage, options);
        SurfaceModel model(device(), {.surface = &surface, .cagePositions = named.cage.positions, .height = &map});
        const std::vector<vec3> positions = twisted(named.cage, 0.9);
        reference.pose(positions);
        const std::vector<Bounds> boxes = FaceSupports(surface).bounds(positions, model.faceHeightBounds);
        for (const SampleQuery& query : randomQueries(surface, 300)) {
            const dvec3 q = displacedFrame(reference, &map, int(query.face), dvec2(query.uv)).q;
            const Bounds& box = boxes[query.face];
            EXPECT_TRUE(glm::all(glm::lessThanEqual(box.lower, q)) && glm::all(glm::lessThanEqual(q, box.upper)))
                << named.name << " face " << query.face;
        }
    }
}

TEST_F(Poses, areRefusedWithOtherCountsOrNumbersThatAreNotFinite) {
    const Cage cage = cube();
    const Surface surface = buildSurface(cage, {});
    SurfaceModel model(device(), {.surface = &surface, .cagePositions = cage.positions});
    Poser poser(device(), model, {.surface = &surface});
    expectFailure(Failure::input, {"7 positions", "8 expected"},
                  [&] { poser.pose(poseOf(std::vector<vec3>(7, vec3(0)))); });
    std::vector<vec3> positions = cage.positions;
    positions[3].y = std::numeric_limits<float>::quiet_NaN();
    expectFailure(Failure::input, {"not finite"}, [&] { poser.pose(poseOf(positions)); });
}

// --- rigs ----------------------------------------------------------------------------------------------------------

mat4 rotationAbout(const vec3& center, double angle, const vec3& shift) {
    const auto c = float(std::cos(angle)), s = float(std::sin(angle));
    const mat4 turn(c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
    mat4 to(1), back(1);
    to[3] = vec4(center + shift, 1);
    back[3] = vec4(-center, 1);
    return to * turn * back;
}

/// Random joints and weights, some of them 0, and random morph targets.
Rig randomRig(const Cage& cage, std::uint32_t influences, std::uint32_t morphs) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0, 1);
    Rig rig{.rest = cage.positions, .jointCount = 5, .morphCount = morphs, .influenceCount = influences};
    for (std::size_t point = 0; point < cage.positions.size(); ++point) {
        float sum = 0;
        for (std::uint32_t i = 0; i < influences; ++i) {
            rig.joints.push_back(random() % rig.jointCount);
            rig.weights.push_back(i > 0 && unit(random) < 0.3f ? 0 : unit(random) + 0.01f);
            sum += rig.weights.back();
        }
        for (std::uint32_t i = 0; i < influences; ++i) rig.weights[rig.weights.size() - 1 - i] /= sum;
    }
    for (std::size_t i = 0; i < morphs * cage.positions.size(); ++i)
        rig.morphOffsets.emplace_back(0.4f * unit(random), 0.4f * unit(random), -0.4f * unit(random));
    return rig;
}

Pose randomPose(const Rig& rig) {
    Pose pose;
    for (std::uint32_t i = 0; i < rig.jointCount; ++i)
        pose.joints.push_back(
            rotationAbout(vec3(0.3f * float(i), 0.1f, 0), 0.2 * i - 0.5, vec3(0, 0.1f * float(i), 0.2f)));
    for (std::uint32_t i = 0; i < rig.morphCount; ++i) pose.morphWeights.push_back(0.7f - 0.5f * float(i));
    return pose;
}

TEST_F(Poses, ofRigsAreThoseOfTheProcessor) {
    const Cage cage = torusWithSeams();
    const Surface surface = buildSurface(cage, {});
    ReferenceSurface reference(cage, {});
    const std::vector<SampleQuery> queries = randomQueries(surface, 200);
    for (const auto& [influences, morphs] :
         {std::pair(0u, 2u), std::pair(1u, 0u), std::pair(4u, 0u), std::pair(8u, 3u)}) {
        const Rig rig = randomRig(cage, influences, morphs);
        Pose pose = randomPose(rig);
        if (influences == 0) pose.joints.resize(rig.jointCount);
        SurfaceModel model(device(), {.surface = &surface, .cagePositions = cage.positions});
        Poser poser(device(), model, {.surface = &surface, .rig = &rig});
        poser.pose(pose);
        EXPECT_EQ(poser.stats().uploadedBytes, 4 * (morphs + 12 * rig.jointCount));
        const std::vector<vec3> positions = posedPositions(&rig, pose);
        EXPECT_GT(distance(dvec3(positions[0]), cage.positions[0]), 0.05);
        reference.pose(positions);
        const std::vector<SampleResult> results = sampler().sample(model, queries);
        for (std::size_t i = 0; i < queries.size(); ++i)
            EXPECT_LT(distance(reference.limit(int(queries[i].face), dvec2(queries[i].uv)).p, results[i].p), 1e-5)
                << influences << " influences, " << morphs << " morphs";
    }
}

// --- stretching heights --------------------------------------------------------------------------------------------

struct StretchScene {
    Cage cage;
    std::vector<vec3> positions;
    SurfaceOptions options{.isolation = 3};
    HeightMap map = sineMap(512, 0.15, 1);
    Surface surface = buildSurface(cage, options);
    ReferenceSurface rest{cage, options}, reference{cage, options};
    SurfaceModel model{device(), {.surface = &surface, .cagePositions = cage.positions, .height = &map}};
    Poser poser{
        device(), model, {.surface = &surface, .heightSpace = HeightSpace::stretch, .restPositions = cage.positions}};

    StretchScene(Cage of, std::vector<vec3> posed) : cage(std::move(of)), positions(std::move(posed)) {
        reference.pose(positions);
        poser.pose(poseOf(positions));
    }
    [[nodiscard]] DisplacedFrame frameAt(const SampleQuery& query, const dvec2& shift = dvec2(0)) const {
        return displacedFrame(reference, &map, int(query.face), dvec2(query.uv) + shift, &rest);
    }
};

TEST_F(Poses, thatGrowTwiceStretchHeightsTwice) {
    const Cage cage = torusWithSeams();
    std::vector<vec3> twice = cage.positions;
    for (vec3& p : twice) p *= 2.0f;
    const StretchScene scene(cage, twice);
    const SurfaceModel still(device(),
                             {.surface = &scene.surface, .cagePositions = cage.positions, .height = &scene.map});
    const std::vector<SampleQuery> queries = randomQueries(scene.surface, 100);
    const std::vector<SampleResult> results = sampler().sample(scene.model, queries),
                                    before = sampler().sample(still, queries);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        EXPECT_NEAR(results[i].h, 2 * before[i].h, 1e-5);
        EXPECT_LT(distance(2.0 * dvec3(before[i].q), results[i].q), 2e-5);
        EXPECT_LT(degrees(dvec3(before[i].m), dvec3(results[i].m)), 0.01);
    }
}

TEST_F(Poses, thatStretchHaveTheReferencesPointsAndTheNormalsOfItsDifferences) {
    std::vector<vec3> bulged = twisted(torusWithSeams(), 0.5);
    for (vec3& p : bulged) p *= 1 + 0.4f * p.y;
    const StretchScene scene(torusWithSeams(), bulged);
    std::vector<SampleQuery> queries;
    for (std::uint32_t face = 0; face < scene.surface.faces.size(); ++face) queries.push_back({face, vec2(0.3f, 0.4f)});
    const std::vector<SampleResult> results = sampler().sample(scene.model, queries);
    double squares = 0, leastFactor = 1e9, mostFactor = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const DisplacedFrame f = scene.frameAt(queries[i]);
        EXPECT_LT(distance(f.q, results[i].q), 1e-5);
        EXPECT_LT(degrees(f.full, dvec3(results[i].m)), 0.05);
        constexpr double kStep = 1e-3;
        const auto q = [&](double du, double dv) { return scene.frameAt(queries[i], dvec2(du, dv)).q; };
        const dvec3 m = glm::cross(q(kStep, 0) - q(-kStep, 0), q(0, kStep) - q(0, -kStep));
        squares += std::pow(degrees(m, dvec3(results[i].m)), 2);
        const double factor = f.height.h / sampleHeight(scene.map, f.tex.st).h;
        leastFactor = std::min(leastFactor, factor), mostFactor = std::max(mostFactor, factor);
    }
    EXPECT_LT(std::sqrt(squares / double(queries.size())), 0.05);
    EXPECT_GT(mostFactor, 1.2 * leastFactor); // this pose stretches unevenly
}

TEST_F(Poses, thatStretchAreTheSameOnAllPathsAndWatertight) {
    const StretchScene scene(cubeOfIslands(), twisted(cubeOfIslands(), 0.6));
    EdgeRater rater(device());
    Capturer capturer(device());
    std::size_t samples = 0;
    for (const Path path : {Path::tessellation, Path::grid, Path::dice}) {
        const TriangleOptions options{.path = path, .rate = 6};
        const EdgeRates rates = rater.rates(scene.model, options, {});
        const CapturedMesh mesh = capturer.capture(scene.model, options, rates);
        EXPECT_EQ(mesh.indices.size() / 3, plannedTriangles(scene.model, path, rates));
        std::vector<std::array<float, 3>> distinct;
        for (const std::uint32_t index : mesh.indices)
            distinct.push_back({mesh.positions[index].x, mesh.positions[index].y, mesh.positions[index].z});
        std::ranges::sort(distinct);
        distinct.erase(std::ranges::unique(distinct).begin(), distinct.end());
        if (samples == 0) samples = distinct.size();
        EXPECT_EQ(distinct.size(), samples) << "path " << int(path);
    }
    EXPECT_EQ(samples, 6u * 36 + 2); // Euler: 6 faces of 6 x 6 cells each
}

} // namespace
} // namespace relief::test

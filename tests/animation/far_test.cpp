// Poses of cages far from the origin against those of the same cage at hand.
#include <cmath>

#include "caches.h"
#include "gltf.h"

namespace relief::test {
namespace {

const dvec3 kAway(1e7, -1e7, 2e7);                ///< a multiple of what coordinates are rounded to
const dvec3 kUtm(512347.078, 120.5, 4187654.321); ///< not one

/// The same cage somewhere else, as a loader gives it.
Cage movedTo(const dvec3& offset, const Cage& cage = torusWithSeams()) {
    Cage moved = cage;
    moved.coordinates = coordinatesFor(computeBounds(cage.positions, [&](const vec3& p) { return dvec3(p) + offset; }));
    for (vec3& p : moved.positions) p = moved.coordinates.toLocal(dvec3(p) + offset);
    return moved;
}

void expectInTheWorld(const std::vector<vec3>& points, const Coordinates& coordinates,
                      const std::vector<dvec3>& expected, double tolerance) {
    ASSERT_EQ(points.size(), expected.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_LT(glm::length(coordinates.toWorld(points[i]) - expected[i]), tolerance) << i;
}

std::vector<dvec3> movedBy(const dvec3& offset, const std::vector<vec3>& points) {
    std::vector<dvec3> moved(points.begin(), points.end());
    for (dvec3& p : moved) p += offset;
    return moved;
}

/// Floats of a cache that is far away hold only this.
TEST(FarCache, isReadWhereItIs) {
    const Cage cage = movedTo(kAway);
    const TemporaryFolder folder;
    const auto rounded = [&](double frame) {
        std::vector<vec3> points;
        for (const dvec3& p : movedBy(kAway, movedPoints(torusWithSeams(), frame))) points.emplace_back(p);
        return points;
    };
    for (const char* name : {"far.pc2", "far.mdd"}) {
        writePointCache(folder / name, {std::uint32_t(cage.positions.size()), 3},
                        [&](std::uint32_t k) { return rounded(k); });
        const auto animation = readQuietly(folder / name, cage);
        EXPECT_TRUE(animation->coordinates() == cage.coordinates);
        expectInTheWorld(animation->pose(2 / 24.0).positions, animation->coordinates(), movedBy(dvec3(0), rounded(2)),
                         1e-9);
    }
}

TEST(FarCache, warnsOnceThatItsFloatsAreCoarse) {
    const TemporaryFolder folder;
    writeFrames(folder / "a.pc2", torusWithSeams(), 2);
    std::vector<std::string> warnings;
    const Warn warn = [&](const std::string& line) { warnings.push_back(line); };
    readPointCache(folder / "a.pc2", torusWithSeams(), {}, warn);
    readPointCache(folder / "a.pc2", movedTo(dvec3(30, 0, 0)), {}, warn);
    readPointCache(folder / "a.pc2", movedTo(kUtm), {}, warn); // the poses lie at hand
    EXPECT_TRUE(warnings.empty());
    std::vector<vec3> away;
    for (const dvec3& p : movedBy(kUtm, torusWithSeams().positions)) away.emplace_back(p);
    writePointCache(folder / "b.pc2", {std::uint32_t(away.size()), 2}, [&](std::uint32_t) { return away; });
    readPointCache(folder / "b.pc2", torusWithSeams(), {}, warn);
    ASSERT_EQ(warnings.size(), 1u);
    EXPECT_NE(warnings[0].find("0.25 units apart"), std::string::npos) << warnings[0];
}

TEST(FarSequence, isReadInDoublePrecision) {
    const Cage cage = movedTo(kUtm);
    const TemporaryFolder folder;
    for (int frame = 1; frame <= 2; ++frame) {
        Cage key = movedTo(kUtm + dvec3(100.0 * frame, 0, 0)); // away from the cage by many of its sizes
        writeObj(folder / fmt::format("a.{}.obj", frame), key);
    }
    const auto animation = readQuietly(folder / "a.{frame}.obj", cage);
    expectInTheWorld(animation->pose(2 / 24.0).positions, animation->coordinates(),
                     movedBy(kUtm + dvec3(200, 0, 0), torusWithSeams().positions), 5e-5);
}

// Whether the cage or its sequence is far away: poses are in coordinates of their own.
TEST(FarSequence, isExactHoweverFarFromItsCage) {
    const TemporaryFolder folder;
    for (const auto& [cageAt, keysAt] :
         {std::pair{dvec3(0), kUtm}, std::pair{kUtm, dvec3(0)}, std::pair{kAway, kUtm}}) {
        for (int frame = 1; frame <= 2; ++frame)
            writeObj(folder / fmt::format("a.{}.obj", frame), movedTo(keysAt + dvec3(0.5 * frame, 0, 0)));
        const auto animation = readQuietly(folder / "a.{frame}.obj", movedTo(cageAt));
        expectInTheWorld(animation->pose(2 / 24.0).positions, animation->coordinates(),
                         movedBy(keysAt + dvec3(1, 0, 0), torusWithSeams().positions), 1e-6);
    }
}

TEST(FarDeformers, doWhatTheyDoNearby) {
    const Cage near = torusWithSeams(), far = movedTo(kAway);
    const std::string words = "twist(axis=y, angle=70) bend(angle=40) translate(x=0.25) rotate(axis=z, angle=10)";
    const auto nearby = deform(stillPose(near), near, words), away = deform(stillPose(far), far, words);
    expectNear(away->pose(0).positions, nearby->pose(0).positions, 1e-6);
    EXPECT_TRUE(away->coordinates() == far.coordinates);
}

// --- skins --------------------------------------------------------------------------------------------------------

/// A node with the torus turns round z by 90 degrees in a second, below a root that stands at `offset`.
GltfFile turningTorus(const dvec3& offset) {
    const DenseMesh mesh = denseMesh(torusWithSeams());
    GltfFile file;
    file.addMesh(mesh.positions, mesh.indices);
    file.addNode({{"children", {1}}, {"translation", {offset.x, offset.y, offset.z}}});
    file.addNode({{"mesh", 0}}, false);
    const float half = std::sqrt(0.5f);
    file.addChannel(1, "rotation", file.add(std::vector<float>{0, 1}),
                    file.add(std::vector<vec4>{{0, 0, 0, 1}, {0, 0, half, half}}));
    return file;
}

std::vector<dvec3> turnedTorus(const dvec3& offset) {
    std::vector<dvec3> points;
    for (const vec3& p : torusWithSeams().positions) points.push_back(dvec3(-p.y, p.x, p.z) + offset);
    return points;
}

std::unique_ptr<Animation> skinOf(const GltfFile& file, const Cage& cage, bool bindsNearest = false) {
    const TemporaryFolder folder;
    putFile(folder / "a.gltf", file.gltf());
    return readSkin(folder / "a.gltf", cage, {.bindsNearest = bindsNearest});
}

void expectTurned(const Animation& animation, const dvec3& offset) {
    const auto at = [&](double seconds) { return posedPositions(animation.rig(), animation.pose(seconds)); };
    expectInTheWorld(at(0), animation.coordinates(), movedBy(offset, torusWithSeams().positions), 1e-6);
    expectInTheWorld(at(1), animation.coordinates(), turnedTorus(offset), 1e-6);
}

TEST(FarSkin, movesACageThatStandsWithIt) {
    for (const dvec3& offset : {kAway, kUtm}) {
        const Cage cage = movedTo(offset);
        for (const bool bindsNearest : {false, true}) {
            const auto animation = skinOf(turningTorus(offset), cage, bindsNearest);
            EXPECT_TRUE(animation->coordinates() == cage.coordinates);
            expectTurned(*animation, offset);
        }
    }
}

TEST(FarSkin, takesACageFromTheSpaceOfItsMeshToWhereItStands) {
    for (const bool bindsNearest : {false, true}) {
        const auto animation = skinOf(turningTorus(kUtm), torusWithSeams(), bindsNearest);
        EXPECT_FALSE(animation->coordinates().isIdentity());
        expectTurned(*animation, kUtm);
    }
}

/// The mesh itself is far away, in whole numbers that floats hold, and inverse bind matrices take it back.
TEST(FarSkin, keepsMeshesThatAreFarFromTheirJoints) {
    const vec3 away(4e6, 0, -8e6);
    const std::vector<vec3> corners = {away, away + vec3(3, 0, 0), away + vec3(0, 5, 0)};
    GltfFile file;
    file.addMesh(corners, {0, 1, 2});
    const int joints = file.add(std::vector<std::uint8_t>(12, 0), "VEC4", kUnsignedByte);
    const int weights = file.add(std::vector<vec4>(3, vec4(1, 0, 0, 0)));
    file.attributes()["JOINTS_0"] = joints;
    file.attributes()["WEIGHTS_0"] = weights;
    file.addNode({{"mesh", 0}, {"skin", 0}});
    file.addNode({{"name", "bone"}});
    mat4 back(1);
    back[3] = vec4(-away, 1);
    const int inverse = file.add(std::vector<mat4>{back});
    file.json["skins"] = {{{"joints", {1}}, {"inverseBindMatrices", inverse}}};
    file.addChannel(1, "translation", file.add(std::vector<float>{0, 1}),
                    file.add(std::vector<vec3>{{0, 0, 0}, {0.125f, 0, 0}}));
    Cage cage;
    cage.positions = {{0, 0, 0}, {3, 0, 0}, {0, 5, 0}};
    addFace(cage, {0, 1, 2});
    const auto animation = skinOf(file, cage);
    expectInTheWorld(posedPositions(animation->rig(), animation->pose(1)), animation->coordinates(),
                     movedBy(dvec3(0.125, 0, 0), cage.positions), 1e-6);
}

TEST(FarSkin, deformsWhereTheSkinStands) {
    const Cage near = torusWithSeams(), far = movedTo(kAway);
    const auto deformed = [&](const dvec3& offset, const Cage& cage) {
        return deform(skinOf(turningTorus(offset), cage), cage, "twist(axis=y, angle=70)")->pose(0).positions;
    };
    expectNear(deformed(kAway, far), deformed(dvec3(0), near), 1e-6);
}

} // namespace
} // namespace relief::test

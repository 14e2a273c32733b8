// Skins, morph targets and moving nodes of glTF files against closed forms.
#include <cmath>
#include <numbers>

#include "animation/animation.h"
#include "gltf.h"
#include "meshes.h"

namespace relief::test {
namespace {

constexpr double kHalfTurn = std::numbers::pi;

std::vector<float> turnRoundZ(double degrees) {
    const double half = degrees * kHalfTurn / 360;
    return {0, 0, float(std::sin(half)), float(std::cos(half))};
}

std::vector<vec4> turnsRoundZ(const std::vector<double>& degrees) {
    std::vector<vec4> turns;
    for (const double angle : degrees) {
        const std::vector<float> q = turnRoundZ(angle);
        turns.emplace_back(q[0], q[1], q[2], q[3]);
    }
    return turns;
}

/// p turned round z.
dvec3 turned(const dvec3& p, double degrees) {
    const double c = std::cos(degrees * kHalfTurn / 180), s = std::sin(degrees * kHalfTurn / 180);
    return {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
}

mat4 movedBy(const vec3& offset) {
    mat4 matrix(1);
    matrix[3] = vec4(offset, 1);
    return matrix;
}

Cage cageOf(const std::vector<vec3>& positions) {
    Cage cage;
    cage.positions = positions;
    for (std::uint32_t i = 2; i < positions.size(); ++i) addFace(cage, {0, i - 1, i});
    return cage;
}

/// A file on disk that has been read for a cage.
struct Skinned {
    TemporaryFolder folder;
    std::unique_ptr<Animation> animation;

    Skinned(const GltfFile& file, const Cage& cage, const SkinOptions& options = {}, const Warn& warn = warnOnStderr) {
        putFile(folder / "a.gltf", file.gltf());
        animation = readSkin(folder / "a.gltf", cage, options, warn);
    }
    [[nodiscard]] std::vector<vec3> at(double seconds) const {
        return posedPositions(animation->rig(), animation->pose(seconds));
    }
};

void expectNear(const std::vector<vec3>& points, const std::vector<dvec3>& expected, double tolerance = 1e-6) {
    ASSERT_EQ(points.size(), expected.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_LT(glm::length(dvec3(points[i]) - expected[i]), tolerance)
            << fmt::format("point {}: ({}, {}, {}), ({}, {}, {}) expected", i, points[i].x, points[i].y, points[i].z,
                           expected[i].x, expected[i].y, expected[i].z);
}

std::vector<dvec3> asDoubles(const std::vector<vec3>& points) { return {points.begin(), points.end()}; }

// --- an arm of two bones along x, which bends at (1, 0, 0) --------------------------------------------------------

const std::vector<vec3> kArm = {{0, 0, 0}, {1, 0.5f, 0}, {2, 0.25f, 0.5f}};

/// One influence per row; weights of the elbow are shared.
GltfFile arm() {
    GltfFile file;
    file.addMesh(kArm, {0, 1, 2});
    const int joints = file.add(std::vector<std::uint8_t>{0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0}, "VEC4", kUnsignedByte);
    const int weights = file.add(std::vector<vec4>{{1, 0, 0, 0}, {0.5f, 0.5f, 0, 0}, {1, 0, 0, 0}});
    file.attributes()["JOINTS_0"] = joints;
    file.attributes()["WEIGHTS_0"] = weights;
    // The mesh is no child of a bone, and its own transform is ignored.
    file.addNode({{"mesh", 0}, {"skin", 0}, {"translation", {50, 60, 70}}});
    file.addNode({{"name", "shoulder"}, {"children", {2}}});
    file.addNode({{"name", "elbow"}, {"translation", {1, 0, 0}}}, false);
    const int inverse = file.add(std::vector<mat4>{mat4(1), movedBy({-1, 0, 0})});
    file.json["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", inverse}}};
    file.addChannel(2, "rotation", file.add(std::vector<float>{0, 2}), file.add(turnsRoundZ({0, 90})));
    return file;
}

/// Where its points are when the elbow is bent.
std::vector<dvec3> bentArm(double degrees) {
    std::vector<dvec3> points = asDoubles(kArm);
    const dvec3 elbow(1, 0, 0);
    points[1] = 0.5 * points[1] + 0.5 * (elbow + turned(points[1] - elbow, degrees));
    points[2] = elbow + turned(points[2] - elbow, degrees);
    return points;
}

TEST(Skin, bendsAnArmAtItsElbow) {
    const Skinned skin(arm(), cageOf(kArm));
    EXPECT_EQ(skin.animation->keyRange(), dvec2(0, 2));
    for (const double seconds : {-1.0, 0.0, 0.3, 1.0, 1.7, 2.0, 9.0})
        expectNear(skin.at(seconds), bentArm(45 * std::clamp(seconds, 0.0, 2.0)));
}

TEST(Skin, posesAreMatricesOfTheJointsThatAreNeeded) {
    GltfFile file = arm();
    file.json["skins"][0]["joints"] = {0, 1, 2, 1}; // two that no vertex names
    file.json["skins"][0].erase("inverseBindMatrices");
    const int joints = file.add(std::vector<std::uint16_t>{1, 0, 0, 0, 1, 2, 0, 0, 2, 3, 3, 3}, "VEC4", kUnsignedShort);
    file.attributes()["JOINTS_0"] = joints;
    const Skinned skin(file, cageOf(kArm), {.bindsNearest = true});
    const Rig& rig = *skin.animation->rig();
    EXPECT_EQ(rig.jointCount, 2u);
    EXPECT_EQ(rig.influenceCount, 2u);
    EXPECT_EQ(rig.joints, (Indices{0, 0, 0, 1, 1, 0}));
    EXPECT_EQ(rig.weights, (std::vector<float>{1, 0, 0.5f, 0.5f, 1, 0}));
    EXPECT_EQ(rig.morphCount, 0u);
    const Pose pose = skin.animation->pose(1);
    EXPECT_EQ(pose.joints.size(), 2u);
    EXPECT_TRUE(pose.positions.empty());
    EXPECT_TRUE(pose.morphWeights.empty());
}

/// As Blender and others write an armature in centimetres: the root of the skeleton is scaled and turned.
TEST(Skin, followsASkeletonWhoseRootIsScaled) {
    GltfFile file = arm();
    file.addNode({{"children", {1}}, {"scale", {0.01, 0.01, 0.01}}, {"rotation", turnRoundZ(90)}});
    file.json["scenes"][0]["nodes"] = {0, 3};
    file.json["nodes"][2]["translation"] = {0, -100, 0}; // (1, 0, 0) in the world
    mat4 shoulder(0), elbow(0);                          // inverses: times 100, turned back by 90 degrees
    shoulder[0] = {0, -100, 0, 0}, shoulder[1] = {100, 0, 0, 0}, shoulder[2] = {0, 0, 100, 0}, shoulder[3].w = 1;
    elbow = movedBy({0, 100, 0}) * shoulder;
    const int inverse = file.add(std::vector<mat4>{shoulder, elbow});
    file.json["skins"][0]["inverseBindMatrices"] = inverse;
    const Skinned skin(file, cageOf(kArm));
    for (const double seconds : {0.0, 0.8, 2.0}) expectNear(skin.at(seconds), bentArm(45 * seconds), 2e-6);
}

TEST(Skin, weightsOfBytesAndShortsAreMadeToAddUp) {
    GltfFile file = arm();
    const int bytes =
        file.add(std::vector<std::uint8_t>{200, 0, 0, 0, 100, 100, 0, 0, 255, 0, 0, 0}, "VEC4", kUnsignedByte, true);
    file.attributes()["WEIGHTS_0"] = bytes;
    expectNear(Skinned(file, cageOf(kArm)).at(1), bentArm(45));
    const int shorts =
        file.add(std::vector<std::uint16_t>{1, 0, 0, 0, 3, 3, 0, 0, 65535, 0, 0, 0}, "VEC4", kUnsignedShort, true);
    file.attributes()["WEIGHTS_0"] = shorts;
    expectNear(Skinned(file, cageOf(kArm)).at(1), bentArm(45));
}

/// Bones that each move along x by their number plus one, all weights of one point in two sets.
GltfFile bones(std::size_t sets, const std::vector<float>& weights) {
    GltfFile file;
    file.addMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2});
    const std::size_t count = 4 * sets;
    for (std::size_t set = 0; set < sets; ++set) {
        std::vector<std::uint8_t> joints;
        std::vector<float> weightsOfSet;
        for (std::size_t i = 0; i < 12; ++i) {
            joints.push_back(std::uint8_t(4 * set + i % 4));
            weightsOfSet.push_back(weights[4 * set + i % 4]);
        }
        const int jointsOfSet = file.add(joints, "VEC4", kUnsignedByte);
        const int weightsAccessor = file.add(weightsOfSet, "VEC4", kFloat);
        file.attributes()[fmt::format("JOINTS_{}", set)] = jointsOfSet;
        file.attributes()[fmt::format("WEIGHTS_{}", set)] = weightsAccessor;
    }
    file.addNode({{"mesh", 0}, {"skin", 0}});
    const int times = file.add(std::vector<float>{0, 1});
    for (std::size_t i = 0; i < count; ++i) {
        const int node = file.addNode({{"name", "bone"}});
        file.json["skins"][0]["joints"].push_back(node);
        file.addChannel(node, "translation", times, file.add(std::vector<vec3>{{0, 0, 0}, {float(i + 1), 0, 0}}));
    }
    return file;
}

TEST(Skin, eightJointsMoveAPoint) {
    const std::vector<float> weights = {0.05f, 0.1f, 0.15f, 0.2f, 0.2f, 0.15f, 0.1f, 0.05f};
    double moved = 0;
    for (std::size_t i = 0; i < 8; ++i) moved += weights[i] * double(i + 1);
    Warnings warnings;
    const Skinned skin(bones(2, weights), cageOf(kArm), {.bindsNearest = true}, warnings.warn());
    EXPECT_EQ(skin.animation->rig()->influenceCount, 8u);
    EXPECT_TRUE(warnings.lines.empty());
    std::vector<dvec3> expected = asDoubles(kArm);
    for (dvec3& p : expected) p.x += moved;
    expectNear(skin.at(1), expected);
}

TEST(Skin, ofMoreThanEightJointsTheLargestWeightsAreKept) {
    // Ninths, but for three zeros and one that is too small.
    const std::vector<float> weights = {1, 0.5f, 1, 1, 0, 1, 1, 0, 1, 1, 0, 1};
    double moved = 0;
    for (std::size_t i = 0; i < 12; ++i)
        if (weights[i] == 1) moved += double(i + 1) / 8;
    Warnings warnings;
    const Skinned skin(bones(3, weights), cageOf(kArm), {.bindsNearest = true}, warnings.warn());
    EXPECT_TRUE(warnings.has("8 largest"));
    std::vector<dvec3> expected = asDoubles(kArm);
    for (dvec3& p : expected) p.x += moved;
    expectNear(skin.at(1), expected);
}

TEST(Skin, aVertexWithoutWeightsFollowsItsFirstJoint) {
    Warnings warnings;
    const Skinned skin(bones(1, {0, 0, 0, 0}), cageOf(kArm), {.bindsNearest = true}, warnings.warn());
    EXPECT_TRUE(warnings.has("vertices without weights are moved by their first joint: 3"));
    expectNear(skin.at(1), {dvec3(1, 0, 0), dvec3(2, 0.5, 0), dvec3(3, 0.25, 0.5)});
}

// --- morph targets -----------------------------------------------------------------------------------------------

const std::vector<vec3> kFirst = {{0, 1, 0}, {0, 2, 0}, {0, 0, 0}}, kSecond = {{0, 0, 4}, {0, 0, 0}, {2, 0, 0}};

/// The arm with two targets; the second one by sparse numbers alone, and half of it is there by default.
GltfFile morphedArm() {
    GltfFile file = arm();
    const int first = file.add(kFirst);
    const int indices = file.addView(std::vector<std::uint8_t>{0, 2});
    const int values = file.addView(std::vector<vec3>{kSecond[0], kSecond[2]});
    const Json sparse = {{"count", 2},
                         {"indices", {{"bufferView", indices}, {"componentType", int(kUnsignedByte)}}},
                         {"values", {{"bufferView", values}}}};
    file.json["accessors"].push_back(
        {{"componentType", int(kFloat)}, {"count", 3}, {"type", "VEC3"}, {"sparse", sparse}});
    const std::size_t second = file.json["accessors"].size() - 1;
    file.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", first}}, {{"POSITION", second}}};
    file.json["meshes"][0]["weights"] = {0, 0.5};
    return file;
}

std::vector<vec3> morphedPoints(double first, double second) {
    std::vector<vec3> points = kArm;
    for (std::size_t i = 0; i < 3; ++i) points[i] += float(first) * kFirst[i] + float(second) * kSecond[i];
    return points;
}

TEST(Skin, morphsBeforeItBends) {
    GltfFile file = morphedArm();
    const int times = file.add(std::vector<float>{0, 2});
    file.addChannel(0, "weights", times, file.add(std::vector<float>{0, 0.5f, 1, -0.25f}));
    const Skinned skin(file, cageOf(morphedPoints(0, 0.5)));
    EXPECT_EQ(skin.animation->rig()->morphCount, 2u);
    expectNear(skin.at(0), asDoubles(morphedPoints(0, 0.5)));
    const std::vector<vec3> half = morphedPoints(0.5, 0.125);
    const dvec3 elbow(1, 0, 0), p1(half[1]), p2(half[2]);
    expectNear(skin.at(1),
               {dvec3(half[0]), 0.5 * p1 + 0.5 * (elbow + turned(p1 - elbow, 45)), elbow + turned(p2 - elbow, 45)});
}

TEST(Skin, weightsOfANodeReplaceThoseOfItsMesh) {
    GltfFile file = morphedArm();
    file.json["nodes"][0]["weights"] = {1, 0};
    const Skinned skin(file, cageOf(morphedPoints(1, 0)));
    EXPECT_EQ(skin.animation->pose(0).morphWeights, (std::vector<float>{1, 0}));
    expectNear(skin.at(0), asDoubles(morphedPoints(1, 0)));
}

// --- moving nodes ------------------------------------------------------------------------------------------------

const std::vector<vec3> kCorners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

/// A triangle without skin, moved along by a node above it.
GltfFile rigid() {
    GltfFile file;
    file.addMesh(kCorners, {0, 1, 2});
    file.addNode({{"children", {1}}, {"name", "handle"}});
    file.addNode({{"mesh", 0}, {"translation", {0, 0, 1}}}, false);
    return file;
}

Cage rigidCage() { return cageOf({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}); }

TEST(Skin, aCubicSplineIsHermites) {
    GltfFile file = rigid();
    // Keys at 1 s and 3 s; in-tangent, value, out-tangent of each.
    const std::vector<vec3> keys = {{9, 9, 9}, {1, 2, 3}, {0.5f, -1, 2}, {-2, 4, 1}, {5, 0, 3}, {9, 9, 9}};
    file.addChannel(0, "translation", file.add(std::vector<float>{1, 3}), file.add(keys), "CUBICSPLINE");
    const Skinned skin(file, rigidCage());
    EXPECT_EQ(skin.animation->keyRange(), dvec2(1, 3));
    // t = 1/4 of 2 s, by hand: the weights of Hermite's basis are 27/32, 9/64, 5/32 and -3/64; tangents count double.
    const dvec3 moved = 27.0 / 32 * dvec3(1, 2, 3) + 9.0 / 32 * dvec3(0.5, -1, 2) + 5.0 / 32 * dvec3(5, 0, 3) -
                        3.0 / 32 * dvec3(-2, 4, 1);
    expectNear(skin.at(1.5), {moved + dvec3(0, 0, 1), moved + dvec3(1, 0, 1), moved + dvec3(0, 1, 1)});
    expectNear({skin.at(0)[0], skin.at(1)[0], skin.at(3)[0], skin.at(4)[0]},
               {dvec3(1, 2, 4), dvec3(1, 2, 4), dvec3(5, 0, 4), dvec3(5, 0, 4)});
}

TEST(Skin, aCubicSplineOfRotationsStaysARotation) {
    GltfFile file = rigid();
    const std::vector<vec4> turns = turnsRoundZ({0, 120});
    const std::vector<vec4> keys = {{}, turns[0], {}, {}, turns[1], {}};
    file.addChannel(0, "rotation", file.add(std::vector<float>{0, 1}), file.add(keys), "CUBICSPLINE");
    // Without tangents the middle is the mean of both, which points half way.
    expectNear(Skinned(file, rigidCage()).at(0.5), {dvec3(0, 0, 1), turned({1, 0, 1}, 60), turned({0, 1, 1}, 60)});
}

TEST(Skin, stepsHoldUntilTheNextKey) {
    GltfFile file = rigid();
    file.addChannel(0, "scale", file.add(std::vector<float>{0, 1, 2}),
                    file.add(std::vector<vec3>{{1, 1, 1}, {2, 3, 4}, {5, 5, 5}}), "STEP");
    const Skinned skin(file, rigidCage());
    for (const double seconds : {1.0, 1.5, std::nextafter(2.0, 0.0)})
        expectNear(skin.at(seconds), {dvec3(0, 0, 4), dvec3(2, 0, 4), dvec3(0, 3, 4)});
    expectNear(skin.at(std::nextafter(1.0, 0.0)), {dvec3(0, 0, 1), dvec3(1, 0, 1), dvec3(0, 1, 1)});
    expectNear(skin.at(2), {dvec3(0, 0, 5), dvec3(5, 0, 5), dvec3(0, 5, 5)});
}

TEST(Skin, rotationsTurnSteadilyTheShortWay) {
    GltfFile file = rigid();
    std::vector<vec4> turns = turnsRoundZ({20, 300}); // from 20 degrees back to -60
    file.addChannel(0, "rotation", file.add(std::vector<float>{0, 1}), file.add(turns));
    const Skinned skin(file, rigidCage());
    for (const double t : {0.0, 0.1, 0.5, 0.9, 1.0}) {
        const double degrees = 20 - 80 * t;
        expectNear(skin.at(t), {dvec3(0, 0, 1), turned({1, 0, 1}, degrees), turned({0, 1, 1}, degrees)});
    }
}

TEST(Skin, rotationsThatDoNotChangeStand) {
    GltfFile file = rigid();
    file.addChannel(0, "rotation", file.add(std::vector<float>{0, 1}), file.add(turnsRoundZ({30, 390})));
    expectNear(Skinned(file, rigidCage()).at(0.25), {dvec3(0, 0, 1), turned({1, 0, 1}, 30), turned({0, 1, 1}, 30)});
}

TEST(Skin, rotationsMayBeBytesOrShorts) {
    GltfFile file = rigid();
    const int times = file.add(std::vector<float>{0, 1});
    const std::vector<std::int16_t> shorts = {0, 0, 0, 32767, 0, 0, 23170, 23170};
    file.addChannel(0, "rotation", times, file.add(shorts, "VEC4", kShort, true));
    expectNear(Skinned(file, rigidCage()).at(0.5), {dvec3(0, 0, 1), turned({1, 0, 1}, 45), turned({0, 1, 1}, 45)});
    const std::vector<std::int8_t> bytes = {0, 0, 0, 127, 0, 0, 127, 0};
    file.json["animations"][0]["samplers"][0]["output"] = file.add(bytes, "VEC4", kByte, true);
    expectNear(Skinned(file, rigidCage()).at(0.5), {dvec3(0, 0, 1), turned({1, 0, 1}, 90), turned({0, 1, 1}, 90)});
}

TEST(Skin, nodesWithMatricesStandBetweenMovingOnes) {
    GltfFile file = rigid();
    file.json["nodes"][1].erase("translation");
    file.json["nodes"][1]["matrix"] = {2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 1};
    file.addChannel(0, "rotation", file.add(std::vector<float>{0, 1}), file.add(turnsRoundZ({0, 90})));
    const Skinned skin(file, cageOf({{0, 0, 1}, {2, 0, 1}, {0, 1, 1}}));
    expectNear(skin.at(1), {dvec3(0, 0, 1), dvec3(0, 2, 1), dvec3(-1, 0, 1)});
}

TEST(Skin, eachPointFollowsItsOwnNode) {
    GltfFile file = arm();
    file.addMesh({{5, 0, 0}, {6, 0, 0}, {5, 1, 0}}, {0, 1, 2});
    const int node = file.addNode({{"mesh", 1}, {"translation", {0, 0, 1}}});
    file.addChannel(node, "translation", file.add(std::vector<float>{0, 2}),
                    file.add(std::vector<vec3>{{0, 0, 1}, {0, 0, 3}}));
    std::vector<vec3> points = kArm;
    points.insert(points.end(), {{5, 0, 1}, {6, 0, 1}, {5, 1, 1}});
    const Skinned skin(file, cageOf(points));
    EXPECT_EQ(skin.animation->rig()->jointCount, 3u);
    std::vector<dvec3> expected = bentArm(45);
    expected.insert(expected.end(), {{5, 0, 2}, {6, 0, 2}, {5, 1, 2}});
    expectNear(skin.at(1), expected);
}

// --- clips -------------------------------------------------------------------------------------------------------

GltfFile twoClips() {
    GltfFile file = rigid();
    const int times = file.add(std::vector<float>{0, 1}), still = file.add(std::vector<float>{4});
    file.addChannel(0, "translation", times, file.add(std::vector<vec3>{{}, {1, 0, 0}}), "LINEAR", 0);
    file.addChannel(0, "translation", still, file.add(std::vector<vec3>{{0, 7, 0}}), "LINEAR", 1);
    file.json["animations"][0]["name"] = "walk";
    file.json["animations"][1]["name"] = "0";
    return file;
}

TEST(Skin, clipsAreFoundByNameAndByNumber) {
    const GltfFile file = twoClips();
    const auto firstAt1 = [&](const std::string& clip) { return Skinned(file, rigidCage(), {.clip = clip}).at(1)[0]; };
    EXPECT_EQ(firstAt1(""), vec3(1, 0, 1));
    EXPECT_EQ(firstAt1("walk"), vec3(1, 0, 1));
    EXPECT_EQ(firstAt1("1"), vec3(0, 7, 1));
    EXPECT_EQ(firstAt1("0"), vec3(0, 7, 1)); // its name
    EXPECT_EQ(Skinned(file, rigidCage(), {.clip = "1"}).animation->keyRange(), dvec2(0, 0));
    GltfFile odd = file;
    odd.json["animations"][1]["name"] = "two\nlines";
    expectFailure(Failure::input, {"1 'two'"}, [&] { Skinned(odd, rigidCage(), {.clip = "run"}); });
    for (const std::string clip : {"run", "2", "-1", "1x", "99999999999999999999"})
        expectFailure(Failure::input, {"a.gltf", "'" + clip + "'", "0 'walk', 1 '0'"}, [&] { firstAt1(clip); });
}

TEST(Skin, withoutAnimationItStands) {
    GltfFile file = arm();
    file.json.erase("animations");
    Warnings warnings;
    const Skinned skin(file, cageOf(kArm), {}, warnings.warn());
    EXPECT_TRUE(warnings.has("no animation"));
    EXPECT_EQ(skin.animation->keyRange(), dvec2(0, 0));
    expectNear(skin.at(3), asDoubles(kArm));
    expectFailure(Failure::input, {"'walk'"}, [&] { Skinned(file, cageOf(kArm), {.clip = "walk"}); });
}

TEST(Skin, whatCannotBeMovedIsIgnored) {
    GltfFile file = twoClips();
    Json& channels = file.json["animations"][0]["channels"];
    channels.push_back({{"sampler", 0}, {"target", {{"node", 0}, {"path", "pointer"}}}});
    channels.push_back({{"sampler", 0}, {"target", {{"node", 0}, {"path", "weights"}}}});
    channels.push_back({{"sampler", 0}, {"target", {{"path", "rotation"}}}}); // of a node that an extension names
    Warnings warnings;
    EXPECT_EQ(Skinned(file, rigidCage(), {}, warnings.warn()).at(1)[0], vec3(1, 0, 1));
    EXPECT_EQ(warnings.lines.size(), 2u);
}

// --- which vertex a cage point takes -----------------------------------------------------------------------------

TEST(Skin, findsVerticesAfterATextHasRoundedThem) {
    std::vector<vec3> points = kArm;
    for (vec3& p : points) p += vec3(8e-6f, -8e-6f, 0);
    const Skinned skin(arm(), cageOf(points));
    expectNear(skin.at(0), asDoubles(kArm)); // the file's own numbers
    for (vec3& p : points) p += vec3(3e-5f, 0, 0);
    expectFailure(Failure::input, {"a.gltf", "3 of 3", "point 0", "--bind-nearest"},
                  [&] { Skinned(arm(), cageOf(points)); });
}

TEST(Skin, namesTheFirstPointWithoutAVertex) {
    std::vector<vec3> points = kArm;
    points.emplace_back(2, 0.25f, 1.0f);
    expectFailure(Failure::input, {"a.gltf", "1 of 4", "point 3 at (2, 0.25, 1)", "0.5 away", "--bind-nearest"},
                  [&] { Skinned(arm(), cageOf(points)); });
}

TEST(Skin, bindsTheNearestVertexAndKeepsThePositionAtRest) {
    GltfFile file = morphedArm();                       // half a morph at rest
    file.json["nodes"][2]["rotation"] = turnRoundZ(30); // and the elbow bent
    std::vector<vec3> points;
    for (const dvec3& p : {dvec3(0.1, 0.2, 1.8), dvec3(2, 1.5, 1), dvec3(3, 1, 0), dvec3(-1, 0, 2)})
        points.emplace_back(p);
    const Skinned skin(file, cageOf(points), {.bindsNearest = true});
    Warnings warnings;
    GltfFile still = file;
    still.json.erase("animations");
    expectNear(Skinned(still, cageOf(points), {.bindsNearest = true}, warnings.warn()).at(0), asDoubles(points));
    // The first has the shoulder alone, which never moves.
    expectNear({skin.at(1)[0]}, {dvec3(points[0])});
}

TEST(Skin, takesTheBindPoseWhereTheCageIsInIt) {
    GltfFile file = arm();
    file.json["nodes"][2]["rotation"] = turnRoundZ(60); // the file's nodes stand in another pose
    for (const bool bindsNearest : {false, true})
        expectNear(Skinned(file, cageOf(kArm), {.bindsNearest = bindsNearest}).at(2), bentArm(90));
    std::vector<vec3> bent;
    for (const dvec3& p : bentArm(60)) bent.emplace_back(p);
    expectNear(Skinned(file, cageOf(bent)).at(2), bentArm(90)); // as what an exporter has put into an OBJ
}

TEST(Skin, jointsWithoutVolumeKeepTheVertex) {
    GltfFile file = rigid();
    file.json["nodes"][0]["scale"] = {0, 0, 0};
    Warnings warnings;
    const Skinned skin(file, cageOf({{1, 0, 0}, {0, 2, 0}, {0, 0, 3}}), {.bindsNearest = true}, warnings.warn());
    for (const vec3& p : skin.at(0)) EXPECT_TRUE(std::isfinite(glm::dot(p, p)));
}

TEST(Skin, aCageFromTheSameFileMatchesExactly) {
    GltfFile file = morphedArm();
    file.json["nodes"][2]["rotation"] = turnRoundZ(33);
    file.addMesh(kCorners, {0, 1, 2});
    file.addNode({{"mesh", 1}, {"rotation", turnRoundZ(11)}, {"scale", {3, 1, 0.1}}, {"translation", {0.1, 7, 0}}});
    const TemporaryFolder folder;
    putFile(folder / "a.glb", file.glb());
    const Cage cage = readCage(folder / "a.glb");
    ASSERT_EQ(cage.positions.size(), 6u);
    const auto animation = readSkin(folder / "a.glb", cage, {});
    file.json.erase("animations");
    putFile(folder / "still.glb", file.glb());
    Warnings warnings;
    const auto still = readSkin(folder / "still.glb", cage, {}, warnings.warn());
    expectNear(posedPositions(still->rig(), still->pose(0)), asDoubles(cage.positions));
    EXPECT_EQ(still->rig()->rest, animation->rig()->rest);
}

// --- what is refused (broken files: tests/cage/gltf_errors_test.cpp) ----------------------------------------------

TEST(Skin, numbersThatMultiplyPastAllFloatsAreRefused) {
    GltfFile file = rigid();
    file.json["nodes"][0]["scale"] = {1e200, 1e200, 1e200};
    file.json["nodes"][1]["scale"] = {1e200, 1e200, 1e200};
    expectFailure(Failure::input, {"a.gltf", "nodes/1", "vertex 0", "finite"}, [&] { Skinned(file, rigidCage()); });

    GltfFile late = rigid();
    const int times = late.add(std::vector<float>{0, 1});
    const int scales = late.add(std::vector<vec3>{{1, 1, 1}, {1e30f, 1, 1}});
    late.addChannel(0, "scale", times, scales);
    late.addChannel(1, "scale", times, scales);
    const Skinned skin(late, rigidCage());
    EXPECT_EQ(skin.at(0)[1], vec3(1, 0, 1));
    expectFailure(Failure::input, {"a.gltf", "node 1", "at 1 s"}, [&] { return skin.at(1); });
}

TEST(Skin, targetsOfManyNodesDoNotFillTheMemory) {
    GltfFile file;
    file.addMesh(kCorners, {0, 1, 2});
    Json targets = Json::array();
    for (int i = 0; i < 1000; ++i) targets.push_back(Json::object());
    file.json["meshes"][0]["primitives"][0]["targets"] = targets;
    Cage cage;
    for (int i = 0; i < 1000; ++i) {
        file.addNode({{"mesh", 0}, {"translation", {0, 0, i}}});
        for (const vec3& p : kCorners) cage.positions.push_back(p + vec3(0, 0, i));
    }
    expectFailure(Failure::input, {"a.gltf", "1000000 morph targets of 3000 cage points"},
                  [&] { Skinned(file, cage, {}, [](const std::string&) {}); });
}

TEST(Skin, posesAreTheSameBitsInAnyOrder) {
    const Skinned skin(arm(), cageOf(kArm));
    const std::vector<vec3> first = skin.at(0.7);
    EXPECT_NE(skin.at(1.9), first);
    EXPECT_EQ(skin.at(0.7), first);
}

} // namespace
} // namespace relief::test

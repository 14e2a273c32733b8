// Cages and meshes far from the origin, very small and very large, against the same ones at hand.
#include <cmath>
#include <cstring>

#include "gltf.h"
#include "meshes.h"

namespace relief::test {
namespace {

/// Offsets of cages: a multiple of every spacing that coordinates are rounded to, and two that are not.
const std::vector<dvec3> kOffsets = {{1e7, -1e7, 2e7}, {512347.078, 120.5, 4187654.321}, {30, 0, 0}};

std::string objOf(const Cage& cage, const dvec3& offset, double scale = 1) {
    std::string text;
    for (const vec3& local : cage.positions) {
        const dvec3 p = scale * dvec3(local) + offset;
        text += fmt::format("v {:.17g} {:.17g} {:.17g}\n", p.x, p.y, p.z);
    }
    std::size_t corner = 0;
    for (const std::uint32_t size : cage.faceSizes) {
        text += "f";
        for (std::uint32_t k = 0; k < size; ++k) text += fmt::format(" {}", cage.corners[corner++] + 1);
        text += "\n";
    }
    return text;
}

/// Of the object's own size: what is lost by a file's doubles and one rounding to floats near the object.
constexpr double kLoss = 2e-7;

void expectInTheWorld(const Cage& cage, const Cage& near, const dvec3& offset, double scale = 1) {
    ASSERT_EQ(cage.positions.size(), near.positions.size());
    const double size = scale * summarize(near).bounds.diagonal();
    for (std::size_t i = 0; i < cage.positions.size(); ++i) {
        const dvec3 expected = scale * dvec3(near.positions[i]) + offset;
        EXPECT_LT(glm::length(cage.coordinates.toWorld(cage.positions[i]) - expected), kLoss * size) << i;
    }
}

TEST(FarObj, isReadInDoublePrecision) {
    for (const dvec3& offset : kOffsets) {
        const Cage cage = parseObj(objOf(torusWithSeams(), offset), "far.obj");
        EXPECT_FALSE(cage.coordinates.isIdentity());
        expectInTheWorld(cage, torusWithSeams(), offset);
    }
}

TEST(FarObj, isTheSameCageWhereTheDistanceIsAMultipleOfTheRounding) {
    const Cage near = parseObj(objOf(torusWithSeams(), dvec3(0)), "near.obj");
    const Cage far = parseObj(objOf(torusWithSeams(), kOffsets[0]), "far.obj");
    EXPECT_TRUE(near.coordinates.isIdentity());
    EXPECT_EQ(far.coordinates.origin, kOffsets[0]);
    for (std::size_t i = 0; i < near.positions.size(); ++i)
        EXPECT_LT(glm::length(dvec3(near.positions[i]) - dvec3(far.positions[i])), 1e-8);
}

TEST(FarObj, ofAnySizeIsTheSameCage) {
    const Cage near = parseObj(objOf(cube(), dvec3(0)), "near.obj");
    for (const int exponent : {-300, -126, -50, 50, 126, 300}) {
        const double scale = std::ldexp(1.0, exponent);
        const Cage cage = parseObj(objOf(cube(), dvec3(0), scale), "sized.obj");
        expectInTheWorld(cage, near, dvec3(0), scale);
        const auto half = float(scale / cage.coordinates.unit);
        EXPECT_EQ(half, 0.5f) << "its side of 2 is one unit";
        for (std::size_t i = 0; i < near.positions.size(); ++i)
            EXPECT_EQ(cage.positions[i], half * near.positions[i]) << exponent;
    }
}

TEST(FarObj, verticesWithoutAFaceDoNotSayWhereItIs) {
    const Cage cage = parseObj(objOf(cube(), kOffsets[1]) + "v 0 0 0\n", "stray.obj");
    EXPECT_LT(glm::length(cage.coordinates.origin - kOffsets[1]), 10);
}

TEST(FarObj, hasTheCoordinatesThatAreGiven) {
    const Coordinates given{.origin = dvec3(8, 0, 0), .unit = 0.25};
    const Cage cage = parseObj(objOf(cube(), dvec3(9, 0, 0)), "given.obj", warnOnStderr, given);
    EXPECT_TRUE(cage.coordinates == given);
    EXPECT_EQ(cage.positions[0], vec3(0, -4, -4));
}

TEST(FarObj, positionsPastTheRangeAreRefusedWithTheLine) {
    for (const std::string word : {"1e101", "-3e200"})
        expectFailure(Failure::input, {"bad.obj:2", word, "1e+100"},
                      [&] { parseObj("v 0 0 0\nv 0 " + word + " 0\nv 0 0 1\nf 1 2 3\n", "bad.obj"); });
}

TEST(FarObj, isWrittenInTheWorld) {
    const TemporaryFolder folder;
    const Cage cage = parseObj(objOf(torusWithSeams(), kOffsets[1]), "far.obj");
    writeObj(folder / "again.obj", cage);
    const Cage again = readCage(folder / "again.obj");
    EXPECT_TRUE(again.coordinates == cage.coordinates);
    EXPECT_EQ(again.positions, cage.positions);
}

TEST(FarObj, hasItsBoundsInTheWorld) {
    const Bounds bounds = summarize(parseObj(objOf(cube(), kOffsets[1]), "far.obj")).bounds;
    EXPECT_LT(glm::length(bounds.center() - kOffsets[1]), 1e-6);
    EXPECT_NEAR(bounds.diagonal(), std::sqrt(12.0), 1e-6);
}

TEST(FarCage, takesANearerOriginWhereItHasMovedAway) {
    Cage cage = cube();
    for (vec3& p : cage.positions) p += vec3(4096, 0, 0);
    recenter(cage);
    EXPECT_EQ(cage.coordinates.origin, dvec3(4096, 0, 0));
    EXPECT_EQ(cage.positions, cube().positions);
    recenter(cage);
    EXPECT_EQ(cage.positions, cube().positions);
}

// --- glTF ---------------------------------------------------------------------------------------------------------

GltfFile gltfOf(const Cage& cage, const Json& node) {
    const DenseMesh mesh = denseMesh(cage);
    GltfFile file;
    file.addMesh(mesh.positions, mesh.indices);
    file.addNode(node);
    return file;
}

Cage cageOfFile(const GltfFile& file) {
    const TemporaryFolder folder;
    putFile(folder / "a.gltf", file.gltf());
    return readCage(folder / "a.gltf");
}

TEST(FarGltf, keepsWhatNodesMoveAwayInDoublePrecision) {
    const Cage near = cageOfFile(gltfOf(torusWithSeams(), {{"mesh", 0}}));
    for (const dvec3& offset : kOffsets) {
        const Cage far =
            cageOfFile(gltfOf(torusWithSeams(), {{"mesh", 0}, {"translation", {offset.x, offset.y, offset.z}}}));
        EXPECT_EQ(far.faceCount(), near.faceCount());
        expectInTheWorld(far, near, offset);
    }
}

TEST(FarGltf, keepsWhatNodesShrinkAndGrow) {
    const Cage near = cageOfFile(gltfOf(cube(), {{"mesh", 0}}));
    for (const double scale : {std::ldexp(1.0, -60), std::ldexp(1.0, 70)}) {
        const Cage cage = cageOfFile(gltfOf(cube(), {{"mesh", 0}, {"scale", {scale, scale, scale}}}));
        EXPECT_EQ(cage.faceCount(), near.faceCount());
        expectInTheWorld(cage, near, dvec3(0), scale);
    }
}

// Weights of a vertex add up to 1 as floats do: 6e-8 too little of 4 million units would be a quarter.
TEST(FarGltf, blendsJointsNearTheCage) {
    Cage cage = torusWithSeams();
    cage.texCoords.clear(), cage.texCorners.clear(); // both sides of a seam would have weights of their own
    const DenseMesh mesh = denseMesh(cage);
    GltfFile file;
    file.addMesh(mesh.positions, mesh.indices);
    const std::size_t count = mesh.positions.size();
    std::vector<std::uint8_t> joints;
    std::vector<vec4> weights;
    for (std::size_t i = 0; i < count; ++i) {
        joints.insert(joints.end(), {0, 1, 0, 0});
        const float share = float(i + 1) / float(3 * count);
        weights.emplace_back(share, 1 - share, 0, 0);
    }
    const int jointAccessor = file.add(joints, "VEC4", kUnsignedByte), weightAccessor = file.add(weights);
    file.attributes()["JOINTS_0"] = jointAccessor;
    file.attributes()["WEIGHTS_0"] = weightAccessor;
    file.addNode({{"mesh", 0}, {"skin", 0}});
    const dvec3 offset = kOffsets[1];
    for (int i = 0; i < 2; ++i) file.addNode({{"translation", {offset.x, offset.y, offset.z}}});
    file.json["skins"] = {{{"joints", {1, 2}}}};
    const Cage far = cageOfFile(file), near = cageOfFile(gltfOf(cage, {{"mesh", 0}}));
    expectInTheWorld(far, near, offset);
}

TEST(FarGltf, warnsWhereTheFloatsOfTheMeshAreCoarse) {
    const TemporaryFolder folder;
    std::vector<vec3> corners = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
    std::vector<std::string> warnings;
    for (const float away : {0.0f, 30.0f, 4e6f}) {
        std::vector<vec3> moved = corners;
        for (vec3& p : moved) p.x += away;
        GltfFile file;
        file.addMesh(moved, {0, 1, 2});
        file.addNode({{"mesh", 0}});
        putFile(folder / "a.gltf", file.gltf());
        warnings.clear();
        readCage(folder / "a.gltf", [&](const std::string& line) { warnings.push_back(line); });
        EXPECT_EQ(warnings.size(), away > 1e6f ? 1u : 0u) << away;
    }
    EXPECT_NE(warnings.at(0).find("0.25 units apart"), std::string::npos) << warnings[0];
}

// --- dense meshes -------------------------------------------------------------------------------------------------

TEST(FarMesh, isTheNearOneInItsOwnCoordinates) {
    const DenseMesh near = denseMesh(parseObj(objOf(cube(), dvec3(0)), "near.obj"));
    const DenseMesh far = denseMesh(parseObj(objOf(cube(), kOffsets[0]), "far.obj"));
    EXPECT_EQ(far.positions, near.positions);
    EXPECT_EQ(far.normals, near.normals);
    EXPECT_EQ(far.coordinates.origin, kOffsets[0]);
}

TEST(FarMesh, readsBackFromEveryFormatWhereItIs) {
    const TemporaryFolder folder;
    const Cage cage = parseObj(objOf(torusWithSeams(), kOffsets[1]), "far.obj");
    const DenseMesh mesh = denseMesh(cage);
    for (const char* name : {"far.obj", "far.glb"}) {
        writeMesh(folder / name, mesh);
        const Cage again = readCage(folder / name);
        const Bounds bounds = summarize(again).bounds, expected = summarize(cage).bounds;
        EXPECT_LT(glm::length(bounds.lower - expected.lower), 1e-6) << name;
        EXPECT_LT(glm::length(bounds.upper - expected.upper), 1e-6) << name;
        EXPECT_EQ(again.positions.size(), cage.positions.size()) << name;
    }
}

TEST(FarMesh, hasDoublesInPly) {
    const TemporaryFolder folder;
    const DenseMesh mesh = denseMesh(parseObj(objOf(cube(), kOffsets[1]), "far.obj"));
    writeMesh(folder / "far.ply", mesh);
    const std::string file = readFile(folder / "far.ply"), mark = "end_header\n";
    EXPECT_NE(file.find("property double x\nproperty double y\nproperty double z\nproperty float nx\n"),
              std::string::npos);
    const char* body = file.data() + file.find(mark) + mark.size();
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        dvec3 p;
        std::memcpy(&p, body + i * (sizeof(dvec3) + sizeof(vec3)), sizeof p);
        EXPECT_EQ(p, mesh.coordinates.toWorld(mesh.positions[i]));
    }
}

} // namespace
} // namespace relief::test

// Objects and scenes as they are loaded from descriptions.
#include <algorithm>

#include "scene/scene.h"
#include "support.h"

namespace relief::test {
namespace {

constexpr const char* kQuads = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\nf 1 2 3 4\nf 2 5 6 3\n";
constexpr const char* kTriangles = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\nt crease 2/1/0 0 2 5.0\n";
/// Two quads side by side that share no vertices.
constexpr const char* kOpen =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 1 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nf 1 2 3 4\nf 5 6 7 8\n";

class Loading : public ::testing::Test {
protected:
    ObjectDesc describe(const char* obj) {
        putFile(folder_ / "cage.obj", obj);
        return {.cage = folder_ / "cage.obj"};
    }
    LoadedObject loadObject(const ObjectDesc& desc, CageState state = CageState::posed) {
        return load(desc, state, warnings_.warn());
    }

    TemporaryFolder folder_;
    Warnings warnings_;
};

TEST_F(Loading, drawsTrianglesThemselvesUnlessASchemeIsNamed) {
    ObjectDesc desc = describe(kTriangles);
    EXPECT_TRUE(loadObject(desc).dense.has_value());
    desc.subdivision = Subdivision::loop;
    const LoadedObject loop = loadObject(desc);
    EXPECT_FALSE(loop.dense.has_value());
    EXPECT_EQ(loop.options.scheme, Scheme::loop);
    EXPECT_EQ(loop.surface.sideCount, 3);
}

TEST_F(Loading, subdividesQuadsUnlessPolygonsAreNamed) {
    ObjectDesc desc = describe(kQuads);
    EXPECT_EQ(loadObject(desc).options.scheme, Scheme::catmark);
    desc.subdivision = Subdivision::bilinear;
    EXPECT_EQ(loadObject(desc).options.scheme, Scheme::bilinear);
    desc.subdivision = Subdivision::none;
    EXPECT_TRUE(loadObject(desc).dense.has_value());
}

TEST_F(Loading, warnsOfTagsThatPolygonsDoNotShow) {
    SceneDesc scene{.object = describe(kTriangles)};
    load(scene, CageState::posed, warnings_.warn());
    EXPECT_TRUE(warnings_.has("subdivision tags"));
    warnings_.lines.clear();
    scene.object.subdivision = Subdivision::none;
    load(scene, CageState::posed, warnings_.warn());
    EXPECT_FALSE(warnings_.has("subdivision tags")) << "polygons were asked for";
}

TEST_F(Loading, refusesHeightsOfPolygonsBeforeItReadsThem) {
    ObjectDesc desc = describe(kTriangles);
    desc.height.path = folder_ / "missing.exr";
    expectFailure(Failure::usage, {"cage.obj", "--scheme"}, [&] { loadObject(desc); });
}

TEST_F(Loading, weldsWithinTheDistanceAndWarnsWithoutOne) {
    ObjectDesc desc = describe(kOpen);
    EXPECT_EQ(loadObject(desc).cage.positions.size(), 8u);
    EXPECT_TRUE(warnings_.has("2 of 8 vertices"));
    desc.weld = Distance{};
    EXPECT_EQ(loadObject(desc).cage.positions.size(), 6u);
    desc.weld = Distance{.value = 2, .isShare = true};
    expectFailure(Failure::usage, {"--weld 200%"}, [&] { loadObject(desc); });
}

TEST_F(Loading, posesACageOrLeavesItAtRest) {
    ObjectDesc desc = describe(kQuads);
    desc.motion.deformers = "translate(z=t)"; // in longest sides of the cage, which is 2
    desc.motion.time = 3;
    const LoadedObject posed = loadObject(desc);
    ASSERT_EQ(posed.restPositions.size(), 6u);
    EXPECT_EQ(posed.restPositions[0].z, 0);
    EXPECT_NEAR(posed.coordinates().toWorld(dvec3(posed.cage.positions[0])).z, 6, 1e-5);
    const LoadedObject resting = loadObject(desc, CageState::atRest);
    EXPECT_TRUE(resting.restPositions.empty());
    EXPECT_EQ(resting.cage.positions[0].z, 0);
    EXPECT_NE(resting.animation, nullptr);
}

TEST_F(Loading, refusesATimeWhereNothingMoves) {
    ObjectDesc desc = describe(kQuads);
    desc.motion.time = 1;
    expectFailure(Failure::usage, {"cage.obj", "--time", "--deform"}, [&] { loadObject(desc); });
}

TEST_F(Loading, listsAllFilesThatOutputsMustNotReplace) {
    SceneDesc scene{.object = {.cage = "a",
                               .height = {.path = "b", .function = "h"},
                               .material = {.albedo = "c", .normalMap = {.path = "g"}},
                               .motion = {.cachePath = "d", .skinPath = "e"}},
                    .lighting = {.environment = "f"},
                    .shading = {.matcap = "i"}};
    std::vector<std::string> files = listFiles(scene);
    std::ranges::sort(files);
    EXPECT_EQ(files, (std::vector<std::string>{"a", "b", "c", "d", "e", "f", "g", "h", "i"}));
}

} // namespace
} // namespace relief::test

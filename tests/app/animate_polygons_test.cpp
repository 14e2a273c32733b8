// Plain polygons that move, as a user sees them.
#include "gltf.h"
#include "program.h"

namespace relief::test {
namespace {

/// A square in the plane z = 0 that faces +z, one of whose corners has no common vertex with the others; its node turns
/// by 40 degrees round y within a second. With one normal for each vertex, or none.
GltfFile turningSquare(bool hasNormals) {
    GltfFile file;
    file.addMesh({{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}, {0, 1, 2, 0, 2, 3});
    if (hasNormals) file.attributes()["NORMAL"] = file.add(std::vector<vec3>(4, vec3(0, 0, 1)));
    file.addNode({{"mesh", 0}});
    file.addChannel(0, "rotation", file.add(std::vector<float>{0, 1}),
                    file.add(std::vector<vec4>{{0, 0, 0, 1}, {0, 0.34202014f, 0, 0.93969262f}}));
    return file;
}

class AnimatePolygons : public ::testing::Test {
protected:
    TemporaryFolder folder_;

    [[nodiscard]] Words animate(const std::string& file, const Words& more) const {
        Words words{"animate", folder_ / file, "--size", "48,48", "--fps", "10"};
        words.insert(words.end(), more.begin(), more.end());
        return words;
    }
    /// The normal in the middle of a picture.
    [[nodiscard]] vec3 normalOf(const std::string& picture) const {
        const Image image = readImage(folder_ / picture);
        const auto channel = [&](const char* name) {
            const std::vector<std::string> names = readImageInfo(folder_ / picture).channelNames;
            return image.at(24, 20)[std::ranges::find(names, name) - names.begin()];
        };
        return {channel("N.X"), channel("N.Y"), channel("N.Z")};
    }
};

const std::string kHeld = "--azimuth 0 --elevation 0 --distance 8 --look-at 0,0,0";

TEST_F(AnimatePolygons, turnWithTheirNormals) {
    for (const bool hasNormals : {true, false}) {
        putFile(folder_ / "a.glb", turningSquare(hasNormals).glb());
        const Words words = animate("a.glb", {"--skin", folder_ / "a.glb", "--layers", "normal", "--frames", "0,10"});
        Words all = words;
        all.insert(all.end(), {"-o", folder_ / "f.{frame}.exr"});
        expectDone(relief(all, kHeld));
        EXPECT_LT(glm::length(normalOf("f.0.exr") - vec3(0, 0, 1)), 2e-3f);
        EXPECT_LT(glm::length(normalOf("f.10.exr") - vec3(0.6427876f, 0, 0.7660444f)), 2e-3f) << hasNormals;
        // As render has them at that time.
        expectDone(relief({"render", folder_ / "a.glb", "--size", "48,48", "--skin", folder_ / "a.glb", "--time", "1",
                           "--layers", "normal", "-o", folder_ / "still.exr"},
                          kHeld));
        EXPECT_LT(glm::length(normalOf("still.exr") - normalOf("f.10.exr")), 1e-4f);
    }
}

TEST_F(AnimatePolygons, takeAllKeysAndCachesAndDeformers) {
    putFile(folder_ / "a.glb", turningSquare(true).glb());
    const auto count = [&](const Words& more) {
        return jsonOf(relief(animate("a.glb", more), "--json")).at("frames").size();
    };
    const std::string pictures = folder_ / "f.{frame}.png";
    EXPECT_EQ(count({"--skin", folder_ / "a.glb", "-o", pictures}), 11u);
    EXPECT_EQ(count({"--skin", folder_ / "a.glb", "-o", folder_ / "a.pc2"}), 11u);
    EXPECT_EQ(count({"--cache", folder_ / "a.pc2", "--frames", "3:4", "-o", pictures}), 2u);
    EXPECT_EQ(count({"--deform", "twist(angle=90*t)", "--frames", "3:4", "-o", pictures}), 2u);
    EXPECT_NE(readFile(folder_ / "f.3.png"), readFile(folder_ / "f.4.png"));
}

TEST_F(AnimatePolygons, haveNoLayerOfMotion) {
    putFile(folder_ / "a.glb", turningSquare(true).glb());
    expectRefused(
        relief(animate("a.glb", {"--skin", folder_ / "a.glb", "--layers", "motion", "-o", folder_ / "f.{frame}.exr"})),
        Failure::usage, {"plain polygons", "--scheme"});
}

TEST_F(AnimatePolygons, printAWarningOnce) {
    GltfFile file = turningSquare(true);
    file.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    putFile(folder_ / "a.glb", file.glb());
    const Outcome outcome =
        relief(animate("a.glb", {"--skin", folder_ / "a.glb", "--frames", "0", "-q", "-o", folder_ / "f.{frame}.png"}));
    EXPECT_EQ(outcome.err, "");
    const std::string err =
        relief(animate("a.glb", {"--skin", folder_ / "a.glb", "--frames", "0", "-o", folder_ / "f.{frame}.png"})).err;
    const std::size_t first = err.find("EXT_mesh_gpu_instancing");
    EXPECT_NE(first, std::string::npos) << err;
    EXPECT_EQ(err.find("EXT_mesh_gpu_instancing", first + 1), std::string::npos) << err;
}

/// Whose times are all 0.
TEST_F(AnimatePolygons, areMovedByCachesWithoutTimes) {
    putFile(folder_ / "a.glb", turningSquare(true).glb());
    expectDone(relief(animate("a.glb", {"--skin", folder_ / "a.glb", "--frames", "0:3", "-o", folder_ / "a.mdd"})));
    putFile(folder_ / "a.mdd", readFile(folder_ / "a.mdd").replace(8, 16, std::string(16, '\0')));
    const Words words = animate("a.glb", {"--cache", folder_ / "a.mdd", "-o", folder_ / "f.{frame}.png"});
    expectRefused(relief(words), Failure::input, {"a.mdd", "times must rise", "--cache-frames"});
    EXPECT_EQ(jsonOf(relief(words, "--cache-frames --json")).at("frames").size(), 4u);
    expectRefused(relief({"animate", cagePath("torus"), "-o", folder_ / "f.{frame}.png"}, "--cache-frames"),
                  Failure::usage, {"--cache"});
}

} // namespace
} // namespace relief::test

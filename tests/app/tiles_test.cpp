// Sets of tiles and maps per face on the command line.
#include "program.h"

namespace relief::test {
namespace {

struct TileVerbs : testing::Test {
    TemporaryFolder folder;

    /// A plane whose texture coordinates go from 0 to 2 along s and to 1 along t.
    [[nodiscard]] std::string plane() const {
        std::string text;
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 5; ++i) text += fmt::format("v {} 0 {}\nvt {} {}\n", i, -j, 0.5 * i, 0.5 * j);
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 4; ++i) {
                const int a = 5 * j + i + 1;
                text += fmt::format("f {0}/{0} {1}/{1} {2}/{2} {3}/{3}\n", a, a + 1, a + 6, a + 5);
            }
        putFile(folder / "plane.obj", text);
        return folder / "plane.obj";
    }
    void write(const std::string& name, float value, int channels = 1) const {
        writeImage(folder / name, {8, 8, channels, std::vector<float>(std::size_t(64 * channels), value)},
                   SampleType::real);
    }
};

TEST_F(TileVerbs, drawSetsAndMapsPerFace) {
    const std::string cage = plane();
    write("h.1001.exr", 0.1f), write("h.1002.exr", 0.2f);
    write("c.1001.exr", 0.5f, 3), write("c.1002.exr", 0.1f, 3);
    const Outcome drawn = relief({"render", cage, "--height", folder / "h.<UDIM>.exr", "--albedo",
                                  folder / "c.<UDIM>.exr", "-o", folder / "p.png"},
                                 "--size 64,64 --detail both");
    EXPECT_EQ(drawn.exitCode, 0) << drawn.err;
    EXPECT_FALSE(contains(drawn.err, "warning")) << drawn.err;
    // There and back: the heights stay.
    expectDone(relief({"map", cage, folder / "h.<UDIM>.exr", "-o", folder / "f.exr", "-q"}));
    const Outcome info = relief({"info", folder / "f.exr", "--json"});
    EXPECT_TRUE(contains(info.out, "\"map_faces\": 8")) << info.out;
    const Outcome checked = relief({"check", cage, "--height", folder / "f.exr"}, "--path dice --json");
    EXPECT_EQ(checked.exitCode, 0) << checked.err;
    const Outcome tiles = relief({"info", folder / "h.<UDIM>.exr"});
    EXPECT_TRUE(contains(tiles.out, "1002")) << tiles.out;
}

TEST_F(TileVerbs, sayWhichTileIsMissing) {
    write("h.1001.exr", 0.1f);
    const Outcome drawn =
        relief({"render", plane(), "--height", folder / "h.<UDIM>.exr", "-o", folder / "p.png"}, "--size 16,16");
    EXPECT_EQ(drawn.exitCode, 0) << drawn.err;
    EXPECT_TRUE(contains(drawn.err, "no tile 1002")) << drawn.err;
}

TEST_F(TileVerbs, refuseWhatDoesNotFit) {
    const std::string cage = plane();
    write("h.1001.exr", 0.1f);
    const auto render = [&](const std::string& map, const std::string& more) {
        return relief({"render", cage, "--height", folder / map, "-o", folder / "p.png"}, more);
    };
    expectRefused(render("h.<UDIM>.exr", "--wrap repeat"), Failure::usage, {"does not repeat"});
    expectRefused(render("x.<UDIM>.exr", ""), Failure::file, {"x.<UDIM>.exr", "no file of this set"});
    expectDone(relief({"map", cage, folder / "h.<UDIM>.exr", "-o", folder / "f.exr", "-q"}));
    expectRefused(render("f.exr", "--detail bump"), Failure::usage, {"f.exr", "texture coordinates"});
    expectRefused(relief({"render", cagePath("cube"), "--height", folder / "f.exr", "-o", folder / "p.png"}),
                  Failure::input, {"f.exr", "another cage", "cube.obj"});
    expectRefused(relief({"map", cage, folder / "h.<UDIM>.exr", "-o", folder / "f.png"}), Failure::usage, {".exr"});
    EXPECT_FALSE(std::filesystem::exists(folder / "p.png"));
}

} // namespace
} // namespace relief::test

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

// The heights stay where they are on the surface while the device moves the cage.
TEST_F(TileVerbs, keepTheirPromisesWhileTheCageMoves) {
    const std::string cage = plane();
    writeImage(folder / "h.1001.exr", sineImage(32, 3), SampleType::real);
    writeImage(folder / "h.1002.exr", sineImage(16, 2), SampleType::real);
    expectDone(relief({"map", cage, folder / "h.<UDIM>.exr", "-o", folder / "f.exr", "-q"}));
    for (const char* map : {"h.<UDIM>.exr", "f.exr"}) {
        const Words motion{"--height", folder / map, "--deform", "twist(angle=60*t) wave(amplitude=0.1*t)"};
        Words words{"check", cage, "--time", "0.7", "--json", "-q"};
        words.insert(words.end(), motion.begin(), motion.end());
        const nlohmann::json certificate = jsonOf(relief(words, "--scale 0.1 --rate 3 --path dice --points 500"));
        EXPECT_EQ(certificate.at("paths").at(0).at("open_edges"), 0) << map;
        // The device poses the cage of `animate`, the host that of `render`.
        Words still{"render", cage, "--time", "0.5", "-o", folder / "still.png"};
        Words moving{"animate", cage, "--frames", "12", "-o", folder / "f.{frame}.png"};
        for (Words* each : {&still, &moving}) each->insert(each->end(), motion.begin(), motion.end());
        // Both by one rasterizer: they know different bounds of what moves, by which one is chosen.
        const std::string view =
            "--scale 0.1 --rate 6 --size 64,64 --distance 12 --look-at 2,0,-1 --show height --raster hardware -q";
        expectDone(relief(still, view));
        expectDone(relief(moving, view));
        const std::vector<float> a = readImage(folder / "still.png").texels, b = readImage(folder / "f.12.png").texels;
        ASSERT_EQ(a.size(), b.size());
        std::size_t differentCount = 0;
        for (std::size_t i = 0; i < a.size(); ++i) differentCount += std::abs(a[i] - b[i]) > 3.0f / 255;
        EXPECT_LE(differentCount, a.size() / 200) << map;
    }
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

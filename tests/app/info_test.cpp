// relief info: cages, pictures, devices, as text and as JSON.
#include <fstream>
#include <sstream>

#include "program.h"

namespace relief::test {
namespace {

TEST(Info, ofACageCountsItsParts) {
    const nlohmann::json ball = jsonOf(relief({"info", "--json", cagePath("ball")})).at(0);
    EXPECT_EQ(ball.at("file"), cagePath("ball"));
    EXPECT_EQ(ball.at("kind"), "cage");
    EXPECT_EQ(ball.at("vertices"), 98);
    EXPECT_EQ(ball.at("faces"), 96);
    EXPECT_EQ(ball.at("quads"), 96);
    EXPECT_EQ(ball.at("edges"), 192);
    EXPECT_EQ(ball.at("extraordinary_vertices"), 8);
    EXPECT_EQ(ball.at("max_valence"), 4);
    EXPECT_EQ(ball.at("boundary_edges"), 0);
    EXPECT_EQ(ball.at("non_manifold_edges"), 0);
    EXPECT_GT(ball.at("seam_edges"), 0);
    EXPECT_GT(ball.at("bounds").at("diagonal"), 3.4);

    const nlohmann::json cube = jsonOf(relief({"info", "--json", cagePath("cube")})).at(0);
    EXPECT_EQ(cube.at("creased_edges"), 12);
    EXPECT_EQ(cube.at("bounds").at("lower"), (nlohmann::json{-1, -1, -1}));
    const nlohmann::json lantern = jsonOf(relief({"info", "--json", cagePath("lantern")})).at(0);
    EXPECT_EQ(lantern.at("n_gons"), 9);
    EXPECT_EQ(lantern.at("triangles"), 16);
    EXPECT_GT(lantern.at("boundary_edges"), 0);
}

// Rules that two levels do not follow to their end; what draws such a surface says so.
TEST(Info, ofACageCountsFacesThatOnlyApproximateTheLimitSurface) {
    const TemporaryFolder folder;
    const std::string path = folder / "cube.obj";
    std::ofstream(path) << std::ifstream(cagePath("lantern")).rdbuf() << "t crease 2/1/0 0 1 2.5\n";
    const auto count = [&](const char* isolation) {
        return jsonOf(relief({"info", "--json", "--scheme", "catmark", "--isolation", isolation, path}))
            .at(0)
            .at("approximate_faces")
            .get<int>();
    };
    EXPECT_GT(count("2"), 0);
    EXPECT_EQ(count("3"), 0);
    const Outcome drawn =
        relief({"export", path, "--scheme", "catmark", "--isolation", "2", "--rate", "1", "-o", folder / "a.obj"});
    EXPECT_EQ(drawn.exitCode, 0);
    EXPECT_TRUE(contains(drawn.err, "faces only approximate the limit surface")) << drawn.err;
}

/// Expects that the values of all rows of a report begin in the same column.
void expectAligned(const std::string& report) {
    constexpr std::size_t kValueColumn = 35;
    std::istringstream lines(report);
    std::size_t rowCount = 0;
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("  ")) continue;
        ++rowCount;
        ASSERT_GT(line.size(), kValueColumn) << line;
        EXPECT_TRUE(line[kValueColumn - 1] == ' ' && line[kValueColumn] != ' ') << line;
    }
    EXPECT_GT(rowCount, 5u) << report;
}

TEST(Info, ofACageReadsAsText) {
    const Outcome outcome = relief({"info", cagePath("ball")});
    EXPECT_EQ(outcome.exitCode, 0);
    EXPECT_EQ(outcome.err, "");
    EXPECT_TRUE(outcome.out.starts_with(cagePath("ball") + "\n")) << outcome.out;
    EXPECT_TRUE(contains(outcome.out, "\n  extraordinary vertices           8\n")) << outcome.out;
    EXPECT_FALSE(contains(outcome.out, "boundary")) << "zeros are omitted: " << outcome.out;
}

TEST(Info, ofMapsShowsTheRangeOfEveryChannel) {
    const TemporaryFolder folder;
    const Image image{2, 1, 2, {-0.25f, 3, 0.5f, 1}};
    writeImage(folder / "two.exr", image, SampleType::real);
    writeImage(folder / "heights.png", sineImage(8, 1), SampleType::uint16);
    const nlohmann::json list = jsonOf(relief({"info", "--json", folder / "two.exr", folder / "heights.png"}));
    ASSERT_EQ(list.size(), 2u);
    const nlohmann::json& two = list[0];
    EXPECT_EQ(two.at("kind"), "picture");
    EXPECT_EQ(two.at("format"), "openexr");
    EXPECT_EQ(two.at("width"), 2);
    EXPECT_EQ(two.at("height"), 1);
    EXPECT_EQ(two.at("sample"), "float");
    EXPECT_EQ(two.at("default_mid"), 0.0);
    EXPECT_EQ(two.at("ranges"), (nlohmann::json{{-0.25, 0.5}, {1, 3}}));
    EXPECT_EQ(two.at("bytes"), 16);
    EXPECT_EQ(two.at("map_format"), "float");
    EXPECT_EQ(two.at("map_bytes"), 4 * (2 + 1));
    EXPECT_EQ(list[1].at("map_format"), "unorm16");
    EXPECT_EQ(list[1].at("sample"), "uint16");
    EXPECT_EQ(list[1].at("default_mid"), 0.5);

    const std::string text = relief({"info", folder / "two.exr"}).out;
    EXPECT_TRUE(contains(text, "\n  default mid                      0\n")) << text;
    EXPECT_TRUE(contains(text, "((-0.25, 0.5), (1, 3))")) << text;
}

/// A 2 x 2 x 2 cube without corners rounded off, whose first face alone has an island in the bright half of the map.
std::string cubeWithSeams() {
    std::string text;
    for (int i = 0; i < 8; ++i) text += fmt::format("v {} {} {}\n", i & 1, i >> 1 & 1, i >> 2);
    text += "vt 0.2 0.5\nvt 0.3 0.5\nvt 0.3 0.6\nvt 0.2 0.6\nvt 0.7 0.5\nvt 0.8 0.5\nvt 0.8 0.6\nvt 0.7 0.6\n";
    const int faces[6][4] = {{1, 5, 7, 3}, {2, 4, 8, 6}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 3, 4, 2}, {5, 6, 8, 7}};
    for (int face = 0; face < 6; ++face) {
        const int first = face == 0 ? 5 : 1;
        text += "f";
        for (int k = 0; k < 4; ++k) text += fmt::format(" {}/{}", faces[face][k], first + k);
        text += "\n";
    }
    return text;
}

TEST(Info, ofACageAndItsMapSaysHowFarSeamsDisagree) {
    const TemporaryFolder folder;
    putFile(folder / "cube.obj", cubeWithSeams());
    Image halves{64, 16, 1, std::vector<float>(64 * 16, 0.25f)};
    for (int y = 0; y < 16; ++y)
        for (int x = 32; x < 64; ++x) *halves.at(x, y) = 0.75f;
    writeImage(folder / "halves.exr", halves, SampleType::real);
    const Words words{"info", folder / "cube.obj", "--height", folder / "halves.exr"};
    const nlohmann::json cube = jsonOf(relief(words, "--scale 0.2 --json")).at(0);
    EXPECT_EQ(cube.at("kind"), "cage");
    EXPECT_EQ(cube.at("map"), folder / "halves.exr");
    EXPECT_NEAR(cube.at("displacement_bound"), 0.15, 1e-7);
    EXPECT_NEAR(cube.at("seam_disagreement_max"), 0.1, 1e-7);
    EXPECT_NEAR(cube.at("seam_max_of_displacement_bound"), 2.0 / 3, 1e-6);
    EXPECT_NEAR(cube.at("seam_mean_of_displacement_bound").get<double>() * 0.15, cube.at("seam_disagreement_mean"),
                1e-9);
    EXPECT_GT(cube.at("seam_disagreement_mean"), 0.1 * 4 / 12 - 1e-6) << "4 of at most 12 seams";
    EXPECT_EQ(cube.at("seam_disagreement_at").at("face"), 0);

    const std::string text = relief(words).out;
    EXPECT_TRUE(contains(text, "\n  seam disagreement max            0.5\n")) << text;
    expectAligned(text);
    EXPECT_FALSE(jsonOf(relief({"info", folder / "cube.obj", "--json"})).at(0).contains("map"));

    writeImage(folder / "flat.png", {4, 4, 1, std::vector<float>(16, 0.5f)}, SampleType::uint8);
    const Outcome flat = relief({"info", folder / "cube.obj", "--height", folder / "flat.png"}, "--scale 1");
    EXPECT_FALSE(contains(flat.out, "disagreement")) << flat.out;
    EXPECT_TRUE(contains(flat.err, "8-bit")) << flat.err;
}

TEST(Info, withAMapNeedsOneCage) {
    const TemporaryFolder folder;
    writeImage(folder / "map.exr", sineImage(8, 1), SampleType::real);
    const std::string height = "--height " + (folder / "map.exr");
    expectRefused(relief({"info", folder / "map.exr"}, height), Failure::usage, {"one cage", "map.exr"});
    expectRefused(relief({"info", cagePath("cube"), cagePath("ball")}, height), Failure::usage, {"one cage"});
    expectRefused(relief({"info", cagePath("cube")}, "--height nothing.exr"), Failure::file, {"nothing.exr"});
}

TEST(Info, ofDevicesNamesThoseThatRenderUses) {
    const nlohmann::json list = jsonOf(relief({"info", "--devices", "--json"}));
    ASSERT_FALSE(list.empty());
    for (const nlohmann::json& device : list) {
        EXPECT_TRUE(device.at("vulkan").get<std::string>().starts_with("1.")) << device;
        EXPECT_GT(device.at("memory"), 0);
        EXPECT_GE(device.at("largest_image_side"), 4096);
        for (const char* key : {"cpu", "tessellation_shaders", "wireframe", "times_passes"})
            EXPECT_TRUE(device.at(key).is_boolean()) << key;
    }
    const TemporaryFolder folder;
    const nlohmann::json render =
        jsonOf(relief({"render", cagePath("cube"), "-o", folder / "a.png"}, "--size 64,64 --json"));
    const auto isUsed = [&](const nlohmann::json& device) { return device.at("device") == render.at("device"); };
    EXPECT_TRUE(std::ranges::any_of(list, isUsed)) << list << render;

    const std::string text = relief({"info", "--devices"}).out;
    EXPECT_TRUE(text.starts_with(list[0].at("device").get<std::string>() + "\n")) << text;
    EXPECT_TRUE(contains(text, "\n  driver ")) << text;
    expectAligned(text);
}

TEST(Info, ofDevicesSaysWhichPathIsTheDefaultAndWhatIsMissing) {
    const nlohmann::json list = jsonOf(relief({"info", "--devices", "--json"}));
    ASSERT_FALSE(list.empty());
    for (const nlohmann::json& device : list) {
        const bool hasTessellation = device.at("tessellation_shaders");
        const bool isMesas = contains(device.at("device"), "llvmpipe");
        EXPECT_EQ(device.at("default_path"), isMesas ? "dice" : hasTessellation ? "tessellation" : "grid") << device;
        EXPECT_TRUE(contains(device.at("default_path_reason"), isMesas ? "measured" : "tessellation shaders"))
            << device;
        EXPECT_TRUE(contains(device.at("reads_tables_as"), "elements")) << device;
        const std::string limits = device.at("limits").dump();
        EXPECT_EQ(contains(limits, "--path tessellation is refused"), !hasTessellation) << device;
        EXPECT_EQ(contains(limits, "--show wireframe is refused"), !device.at("wireframe")) << device;
    }
    EXPECT_TRUE(contains(relief({"info", "--devices"}).out, "\n  default path   ")) << "as text too";
}

TEST(Info, printsWarningsUnlessQuiet) {
    const TemporaryFolder folder;
    putFile(folder / "odd.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nt unknown 1/0/0 3\n");
    EXPECT_TRUE(relief({"info", folder / "odd.obj"}).err.starts_with("warning: "));
    EXPECT_EQ(relief({"info", folder / "odd.obj", "-q"}).err, "");
}

} // namespace
} // namespace relief::test

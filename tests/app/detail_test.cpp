// --detail, --normal-map, --filter and --compare on the command line.
#include "program.h"

namespace relief::test {
namespace {

class DetailOption : public ::testing::Test {
protected:
    void SetUp() override {
        writeImage(path("map.exr"), sineImage(128, 6), SampleType::real);
        Image tilted{4, 4, 3, {}};
        for (int i = 0; i < 16; ++i) tilted.texels.insert(tilted.texels.end(), {0.8f, 0.5f, 0.9f});
        writeImage(path("normals.png"), tilted, SampleType::uint8);
    }
    [[nodiscard]] std::string path(const std::string& name) const { return folder_ / name; }
    Outcome render(const std::string& cage, const std::string& options, const std::string& target = "x.png") {
        Words words{"render", cage, "-o", path(target)};
        for (std::string& word : split("-q --rate 8 --size 64,64 --no-shadows " + options)) {
            const bool isFile = word.starts_with('@'); // of the folder
            words.push_back(isFile ? path(word.substr(1)) : word);
        }
        return relief(words);
    }
    Image drawn(const std::string& options) {
        expectDone(render(cagePath("torus"), "--look-at 0,0,0 --distance 5 " + options));
        return readImage(path("x.png"));
    }
    TemporaryFolder folder_;
};

double meanDifference255(const Image& a, const Image& b) {
    EXPECT_EQ(a.texels.size(), b.texels.size());
    double sum = 0;
    for (std::size_t i = 0; i < a.texels.size(); ++i) sum += std::abs(double(a.texels[i]) - double(b.texels[i]));
    return 255 * sum / double(a.texels.size());
}

TEST_F(DetailOption, drawsFourTechniquesOnEveryPath) {
    const Image smooth = drawn("--raster hardware");
    for (const std::string where : {"tessellation", "grid", "dice"}) {
        const std::string map = "--height @map.exr --scale 0.03 --raster hardware --path " + where + " --detail ";
        const Image displaced = drawn(map + "displacement"), bumped = drawn(map + "bump"), both = drawn(map + "both");
        EXPECT_LT(meanDifference255(drawn(map + "none"), smooth), 0.1) << where;
        EXPECT_GT(meanDifference255(displaced, smooth), 1) << where;
        EXPECT_GT(meanDifference255(bumped, smooth), 1) << where;
        EXPECT_GT(meanDifference255(both, displaced), 0.3) << where;
    }
}

TEST_F(DetailOption, bendsNormalsByAMapInTangentSpace) {
    const Image smooth = drawn(""), mapped = drawn("--normal-map @normals.png");
    EXPECT_GT(meanDifference255(mapped, smooth), 1);
    EXPECT_GT(meanDifference255(drawn("--normal-map @normals.png --normal-space object"), mapped), 1);
    EXPECT_GT(meanDifference255(drawn("--normal-map @normals.png --height @map.exr --scale 0.03"), mapped), 1);
}

TEST_F(DetailOption, refusesNormalsOfObjectSpaceOnCagesThatMove) {
    expectRefused(
        render(cagePath("torus"), "--normal-map @normals.png --normal-space object --deform twist(axis=y,angle=30)"),
        Failure::usage, {"normals.png", "object space", "--normal-space tangent"});
    EXPECT_FALSE(std::filesystem::exists(path("x.png")));
}

TEST_F(DetailOption, looksMapsUpByEveryFilter) {
    const std::string map = "--height @map.exr --scale 0.03 --detail bump ";
    const Image mipmap = drawn(map);
    EXPECT_GT(meanDifference255(drawn(map + "--filter nearest"), mipmap), 0.1);
    EXPECT_EQ(drawn(map + "--filter mipmap").texels, mipmap.texels);
    const Outcome anisotropic = render(cagePath("torus"), map + "--filter anisotropic --anisotropy 16");
    EXPECT_EQ(anisotropic.exitCode, 0) << anisotropic.err;
    expectRefused(render(cagePath("torus"), map + "--filter cubic"), Failure::usage, {"--filter", "cubic"});
    expectRefused(render(cagePath("torus"), map + "--anisotropy 4"), Failure::usage, {"--anisotropy", "--filter"});
}

TEST_F(DetailOption, needsTextureCoordinatesOnTriangles) {
    putFile(path("bare.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    putFile(path("mapped.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    const std::string bump = "--height @map.exr --scale 0.03 --detail bump";
    for (const std::string& options : {bump, std::string("--normal-map @normals.png")}) {
        expectRefused(render(path("bare.obj"), options), Failure::input, {"bare.obj", "no texture coordinates"});
        expectDone(render(path("mapped.obj"), options + " --azimuth 0"));
    }
    expectRefused(render(path("mapped.obj"), "--height @map.exr"), Failure::usage, {"mapped.obj", "--detail bump"});
}

TEST_F(DetailOption, saysSoWhereThereAreNoHeights) {
    for (const char* detail : {"bump", "both"}) {
        const Outcome outcome = relief({"render", cagePath("torus"), "--detail", detail, "-o", path("x.png")},
                                       "--rate 4 --size 16,16 --no-shadows");
        EXPECT_EQ(outcome.exitCode, 0);
        EXPECT_TRUE(contains(outcome.err, std::string("--detail ") + detail + " shows nothing without heights"))
            << outcome.err;
    }
}

TEST_F(DetailOption, comparesTechniquesSideBySide) {
    const std::string map = "--height @map.exr --scale 0.03 ";
    const Outcome outcome = render(cagePath("torus"), map + "--compare bump,displacement,both --json");
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const Image sheet = readImage(path("x.png"));
    EXPECT_EQ(sheet.width, 3 * 64 + 2 * 4);
    EXPECT_GT(sheet.height, 64);
    bool hasCaption = false;
    for (int x = 0; x < 64; ++x)
        for (int y = 66; y < sheet.height; ++y) hasCaption = hasCaption || sheet.at(x, y)[0] < 0.5f;
    EXPECT_TRUE(hasCaption);
    const nlohmann::json reports = nlohmann::json::parse(outcome.out);
    ASSERT_EQ(reports.size(), 3u);
    EXPECT_EQ(reports[0]["detail"], "bump");
    EXPECT_EQ(reports[2]["detail"], "both");
    EXPECT_GT(reports[2]["frame_ms"], 0);
    // Slopes are 4 bytes per texel, mips included.
    EXPECT_GT(reports[0]["map_bytes"].get<int>(), 4 * 128 * 128);
    EXPECT_EQ(reports[2]["map_bytes"].get<int>(),
              reports[0]["map_bytes"].get<int>() + reports[1]["map_bytes"].get<int>());
    expectDone(relief(
        {"render", cagePath("torus"), "--height", path("map.exr"), "--compare", "bump, none", "-o", path("y.png")},
        "-q --rate 8 --size 64,64"));
    EXPECT_EQ(readImage(path("y.png")).width, 2 * 64 + 4);
    expectRefused(render(cagePath("torus"), "--compare bump"), Failure::usage, {"--compare", "--height"});
    expectRefused(render(cagePath("torus"), map + "--compare bump,bumps"), Failure::usage, {"bumps"});
    expectRefused(render(cagePath("torus"), map + "--compare bump", "x.exr"), Failure::usage, {".png"});
}

} // namespace
} // namespace relief::test

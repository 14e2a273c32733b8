// Environments, matcaps, tables and lights through the command line: what the verbs write, and what is refused.
#include "program.h"

namespace relief::test {
namespace {

struct LightVerbs : testing::Test {
    TemporaryFolder folder;
    const std::string sky = folder / "sky.exr", cube = cagePath("cube");

    void SetUp() override {
        Image image{64, 32, 3, {}};
        for (int i = 0; i < 64 * 32; ++i)
            image.texels.insert(image.texels.end(), {float(i % 64) / 64, float(i / 64) / 32, 0.5f});
        writeImage(sky, image, SampleType::real);
    }
    [[nodiscard]] Outcome draw(const std::string& options, const Words& more = {}) const {
        Words words{"render", cube, "-o", folder / "p.exr", "--size", "48,48", "--rate", "4"};
        words.insert(words.end(), more.begin(), more.end());
        return relief(words, options);
    }
    [[nodiscard]] std::vector<float> drawn(const std::string& options, const Words& more = {}) const {
        expectDone(draw(options + " -q", more));
        return readImage(folder / "p.exr").texels;
    }
};

TEST_F(LightVerbs, convertEnvironmentsAndSayWhatTheyWere) {
    const Outcome faces = relief({"environment", sky, "-o", folder / "f_{face}.exr"}, "--side 16");
    EXPECT_EQ(faces.exitCode, 0) << faces.err;
    EXPECT_TRUE(
        contains(faces.err, "a cube (six files) of 6 x 16 x 16 texels, from an equirectangular picture of 64 x 32"))
        << faces.err;
    for (const char* face : {"px", "nx", "py", "ny", "pz", "nz"})
        EXPECT_EQ(readImageInfo(folder / fmt::format("f_{}.exr", face)).width, 16) << face;
    const nlohmann::json ball =
        jsonOf(relief({"environment", folder / "f_{face}.exr", "-o", folder / "ball.exr", "--json"}, "--shape sphere"));
    EXPECT_EQ(ball.at("shape"), "sphere");
    EXPECT_EQ(ball.at("side"), 64);
    EXPECT_EQ(ball.at("source_shape"), "cube");
    expectDone(relief({"environment", folder / "ball.exr", "-o", folder / "strip.png", "-q"},
                      "--shape cube --layout strip --blur 0.5 --side 8"));
    EXPECT_EQ(readImageInfo(folder / "strip.png").width, 48);

    // A scene, seen from a point: the cube in front of it, and the sky elsewhere.
    expectDone(relief({"environment", "--from", cube, "--environment", sky, "-o", folder / "room_{face}.exr", "-q"},
                      "--at 0,0,4 --side 32 --rate 4 --color 1,0,0"));
    const Image front = readImage(folder / "room_pz.exr"), behind = readImage(folder / "room_nz.exr");
    EXPECT_NEAR(front.at(2, 16)[2], 0.5, 0.01) << "the sky beside the cube";
    EXPECT_LT(front.at(16, 16)[2], 0.3f) << "the cube, which is red";
    for (int x = 0; x < 32; x += 5) EXPECT_NEAR(behind.at(x, 16)[2], 0.5, 0.01) << "nothing but sky";
    expectRefused(relief({"environment", "--from", cube, "-o", folder / "x.exr"}), Failure::usage, {"--at"});
    expectRefused(relief({"environment", "-o", folder / "x.exr"}), Failure::usage, {"--from"});

    expectRefused(relief({"environment", sky, "-o", folder / "g_{face}.exr"}, "--shape sphere"), Failure::usage,
                  {"six faces"});
    expectRefused(relief({"environment", sky, "-o", sky}), Failure::usage, {sky});
    expectRefused(relief({"environment", folder / "none_{face}.exr", "-o", folder / "x.exr"}), Failure::input,
                  {"none_px.exr"});
    EXPECT_FALSE(std::filesystem::exists(folder / "x.exr"));
}

// Pictures differ by what is asked for, and what is the default changes nothing.
TEST_F(LightVerbs, areSeenInThePicture) {
    const std::vector<float> usual = drawn("");
    for (const char* same :
         {"--shading physical", "--occlusion 0", "--environment-azimuth 0", "--light -25,50", "--light -25 50"})
        EXPECT_EQ(drawn(same), usual) << same;
    for (const char* other :
         {"--shading phong", "--shading table", "--shading matcap", "--shading water", "--metallic 1", "--roughness 0",
          "--light 5,50 --light 90,20", "--light 5,50,1", "--light 5,50,2.9,1,0,0", "--occlusion 0.5"})
        EXPECT_NE(drawn(other), usual) << other;

    const Outcome noted = draw("", {"--environment", sky});
    EXPECT_TRUE(contains(noted.err, "sky.exr: an equirectangular picture of 64 x 32 texels\n")) << noted.err;
    EXPECT_FALSE(contains(draw("--environment-shape equirect", {"--environment", sky}).err, "equirectangular"));
    const nlohmann::json json = jsonOf(draw("--json --light 0,50 --light 90,20 --occlusion 0.1"));
    EXPECT_GT(json.at("occlusion_ms"), 0);
    EXPECT_GT(json.at("other_lights_ms"), 0);

    expectRefused(draw("--light 40,50,-1"), Failure::usage, {"--light", "AZ,EL,STRENGTH"});
    expectRefused(draw("--light 40,50,1,1"), Failure::usage, {"--light"});
    expectRefused(draw("--metallic 1.1"), Failure::usage, {"0..1"});
    EXPECT_NE(drawn("--shading table --table-at vertices --light 1,20 --light 90,40"),
              drawn("--shading table --table-at vertices --light 1,20"));
    expectRefused(draw("--shading matcap", {"--matcap", sky}), Failure::input, {"square", "64 x 32"});
}

// A quarter of a turn is a picture whose columns are moved by a quarter of its width.
TEST_F(LightVerbs, turnTheEnvironmentAsItsPictureIsTurned) {
    const Image before = readImage(sky);
    Image after = before;
    for (int y = 0; y < before.height; ++y)
        for (int x = 0; x < before.width; ++x)
            std::copy_n(before.at((x + before.width / 4) % before.width, y), before.channels, after.at(x, y));
    writeImage(folder / "turned.exr", after, SampleType::real);
    for (const char* material : {"--roughness 0 --metallic 1", "--roughness 1", "--roughness 0.4"}) {
        const std::vector<float> turned =
            drawn(std::string("--no-shadows --environment ") + sky + " --environment-azimuth 90 " + material);
        const std::vector<float> moved = drawn("--no-shadows --environment " + folder / "turned.exr" + " " + material);
        ASSERT_EQ(turned.size(), moved.size());
        float most = 0;
        for (std::size_t i = 0; i < turned.size(); ++i) most = std::max(most, std::abs(turned[i] - moved[i]));
        EXPECT_LE(most, 1.5f / 255) << material;
        EXPECT_NE(turned, drawn(std::string("--no-shadows --environment ") + sky + " " + material)) << material;
    }
}

// Depth and tiles of a floor are in cage units, from the cage's lowest point on: a huge cage high above shows the same
// as a small one with a floor so much deeper.
TEST_F(LightVerbs, drawWaterOverAFloor) {
    const auto writePlane = [&](const char* name, double scale, double height) {
        std::string text;
        for (const auto& [x, z] : {std::pair(-1, 1), std::pair(1, 1), std::pair(1, -1), std::pair(-1, -1)})
            text += fmt::format("v {} {} {}\n", scale * x, height, scale * z);
        putFile(folder / name, text + "f 1 2 3 4\n");
    };
    writePlane("near.obj", 1, 0), writePlane("far.obj", 1e7, 3e7);
    const auto drawPlane = [&](const char* name, const std::string& floor) {
        expectDone(relief({"render", folder / name, "-o", folder / "w.png", "--water-floor", floor, "-q"},
                          "--shading water --size 64,64 --rate 8 --elevation 40 --no-shadows"));
        return readImage(folder / "w.png").texels;
    };
    const std::vector<float> near = drawPlane("near.obj", "0.5,0.8,0.2,0.1,0.4"),
                             far = drawPlane("far.obj", "5e6,0.8,0.2,0.1,4e6");
    EXPECT_NE(drawPlane("near.obj", "1.5,0.8,0.2,0.1,0.4"), near);
    EXPECT_NE(drawPlane("near.obj", "0.5"), near);
    double different = 0;
    for (std::size_t i = 0; i < near.size(); ++i) different += std::abs(near[i] - far[i]) > 1.5 / 255;
    EXPECT_LT(different / double(near.size()), 0.01);
    for (const char* bad : {"0", "-1", "0.5,1,1", "0.5,1,1,2", "0.5,1,1,1,-1", "deep"})
        expectRefused(draw(std::string("--shading water --water-floor=") + bad), Failure::usage, {"--water-floor"});
}

TEST_F(LightVerbs, drawBallsAndTables) {
    const std::string ball = folder / "ball.exr";
    expectDone(relief({"matcap", "-o", ball, "-q"}, "--side 64 --color 0.2,0.4,0.8 --metallic 1 --roughness 0.4"));
    const Image drawnBall = readImage(ball);
    EXPECT_EQ(drawnBall.width, 64);
    EXPECT_GT(drawnBall.at(32, 32)[2], 2 * drawnBall.at(32, 32)[0]);
    EXPECT_EQ(drawnBall.at(0, 0)[2], 0);
    EXPECT_NE(drawn("--shading matcap", {"--matcap", ball}), drawn("--shading matcap"));

    // Rows of equal v.r, n.l to the right: c = color (k_a + k_d s) + k_s t^e at the corners.
    expectDone(relief({"shading-table", "-o", folder / "t.exr", "-q"}, "--color 0.5,0.5,1 --phong 0.1,0.6,0.3,8"));
    const Image table = readImage(folder / "t.exr");
    EXPECT_EQ(table.width, 256);
    EXPECT_NEAR(table.at(0, 0)[0], 0.5 * 0.1, 1e-6);
    EXPECT_NEAR(table.at(255, 0)[2], 0.7, 1e-6);
    EXPECT_NEAR(table.at(255, 255)[0], 0.35 + 0.3, 1e-6);
    EXPECT_NEAR(table.at(0, 128)[2], 0.1 + 0.3 * std::pow(128 / 255.0, 8), 1e-6);
    expectRefused(relief({"shading-table", "-o", folder / "t.txt"}), Failure::usage, {"t.txt"});
}

} // namespace
} // namespace relief::test

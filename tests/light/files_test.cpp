// Environments in files: what they are taken for, and what is refused.
#include <filesystem>
#include <limits>

#include <gtest/gtest.h>

#include "light/pictures.h"
#include "support.h"

namespace relief::test {
namespace {

struct EnvironmentFiles : testing::Test {
    const TemporaryFolder folder;
    [[nodiscard]] std::string at(const std::string& name) const { return folder / name; }

    /// Expects one line of the failure that has all words.
    static void expectRefused(const std::string& path, std::optional<EnvironmentShape> shape,
                              const std::vector<std::string>& words) {
        try {
            readEnvironment(path, shape);
            ADD_FAILURE() << path << " was read";
        } catch (const Error& error) {
            EXPECT_EQ(error.failure, Failure::input) << error.what();
            const std::string line = error.what();
            EXPECT_EQ(line.find('\n'), std::string::npos);
            for (const std::string& word : words) EXPECT_NE(line.find(word), std::string::npos) << line;
        }
    }
};

TEST_F(EnvironmentFiles, areTakenForWhatTheirSidesSay) {
    const EnvironmentPicture cube = labelledCube(16);
    const struct {
        const char* name;
        CubeLayout layout;
    } cubes[] = {{"cross.exr", CubeLayout::cross},
                 {"column.exr", CubeLayout::column},
                 {"strip.exr", CubeLayout::strip},
                 {"face_{face}.exr", CubeLayout::files}};
    for (const auto& each : cubes) {
        writeEnvironment(at(each.name), cube, each.layout, SampleType::real);
        const EnvironmentFile file = readEnvironment(at(each.name));
        EXPECT_TRUE(file.isChosen);
        EXPECT_EQ(file.layout, each.layout) << each.name;
        ASSERT_EQ(file.picture.images.size(), 6u);
        for (std::size_t face = 0; face < 6; ++face)
            EXPECT_EQ(file.picture.images[face].texels, cube.images[face].texels) << each.name << ' ' << face;
    }
    const EnvironmentPicture ball = convert(cube, EnvironmentShape::sphere, 64);
    writeEnvironment(at("ball.exr"), ball, {}, SampleType::real);
    EXPECT_EQ(readEnvironment(at("ball.exr")).picture.shape, EnvironmentShape::sphere);
    writeEnvironment(at("sky.exr"), convert(cube, EnvironmentShape::equirect, 32), {}, SampleType::real);
    const EnvironmentFile sky = readEnvironment(at("sky.exr"));
    EXPECT_EQ(sky.picture.shape, EnvironmentShape::equirect);
    EXPECT_EQ(describe(sky.picture, sky.layout), "an equirectangular picture of 64 x 32 texels");
    EXPECT_FALSE(readEnvironment(at("sky.exr"), EnvironmentShape::equirect).isChosen);
}

// In the cross the picture goes on from face to face as the eye turns to the right; in the column, downwards.
TEST_F(EnvironmentFiles, crossesAreUnfoldedCubes) {
    const EnvironmentPicture cube = drawPicture(EnvironmentShape::cube, 32, smoothLight);
    const Image cross = arrangeFaces(cube, CubeLayout::cross), column = arrangeFaces(cube, CubeLayout::column);
    const auto expectClose = [](const Image& image, ivec2 a, ivec2 b) {
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(image.at(a.x, a.y)[c], image.at(b.x, b.y)[c], 0.05) << a.x << ' ' << a.y;
    };
    for (int i = 0; i < 32; i += 5) {
        for (int face = 1; face < 4; ++face) expectClose(cross, {32 * face - 1, 32 + i}, {32 * face, 32 + i});
        expectClose(cross, {32 + i, 31}, {32 + i, 32}); // above and below the front
        expectClose(cross, {32 + i, 63}, {32 + i, 64});
        for (int face = 1; face < 4; ++face) expectClose(column, {32 + i, 32 * face - 1}, {32 + i, 32 * face});
    }
    EXPECT_EQ(cross.at(0, 0)[0], 0);
}

TEST_F(EnvironmentFiles, withOtherNamesOfFacesAreFound) {
    const EnvironmentPicture cube = labelledCube(8);
    const char* names[] = {"right", "left", "up", "down", "front", "back"};
    for (std::size_t face = 0; face < 6; ++face)
        writeImage(at(fmt::format("room_{}.exr", names[face])), cube.images[face], SampleType::real);
    EXPECT_EQ(readEnvironment(at("room_{face}.exr")).picture.images[5].texels, cube.images[5].texels);
}

TEST_F(EnvironmentFiles, thatAreMalformedAreRefused) {
    const auto write = [&](const char* name, Image image) { writeImage(at(name), image, SampleType::real); };
    const auto even = [](int width, int height) {
        return drawImage(width, height, [](double, double) { return dvec3(0.5); });
    };
    write("odd.exr", even(17, 8));
    expectRefused(at("odd.exr"), {}, {"odd.exr", "twice as wide as high", "17 x 8"});
    write("grey.exr", {16, 8, 1, std::vector<float>(128, 0.5f)});
    expectRefused(at("grey.exr"), {}, {"grey.exr", "1 channels"});
    write("square.exr", even(16, 16));
    expectRefused(at("square.exr"), {}, {"square.exr", "black outside of the ball", "--environment-shape sphere"});
    EXPECT_EQ(readEnvironment(at("square.exr"), EnvironmentShape::sphere).picture.side(), 16);
    write("wide.exr", even(16, 8));
    expectRefused(at("wide.exr"), EnvironmentShape::sphere, {"square", "16 x 8"});
    expectRefused(at("wide.exr"), EnvironmentShape::cube, {"4 x 3", "16 x 8"});
    expectRefused(at("square.exr"), EnvironmentShape::equirect, {"twice as wide as high", "16 x 16"});
    Image photograph = even(32, 24); // 4:3 as cameras make them
    photograph.at(3, 3)[1] = 0.1f;
    write("photograph.exr", photograph);
    expectRefused(at("photograph.exr"), {}, {"photograph.exr", "beside them", "--environment-shape cube"});

    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), -1.0f, 1e13f, INFINITY}) {
        Image image = even(16, 8);
        image.at(5, 6)[1] = bad;
        write("bad.exr", image);
        expectRefused(at("bad.exr"), {}, {"bad.exr", "pixel 5,6", "0..1e+12"});
    }

    writeEnvironment(at("c_{face}.exr"), labelledCube(8), CubeLayout::files, SampleType::real);
    write("c_ny.exr", even(4, 4));
    expectRefused(at("c_{face}.exr"), {}, {"c_ny.exr", "4 x 4", "six squares of one size", "c_px.exr is 8 x 8"});
    write("c_ny.exr", even(8, 4));
    expectRefused(at("c_{face}.exr"), {}, {"c_ny.exr", "8 x 4"});
    std::filesystem::remove(at("c_ny.exr"));
    expectRefused(at("c_{face}.exr"), {}, {"there is no", "c_ny.exr", "six faces"});
    expectRefused(at("none_{face}.exr"), {}, {"none_px.exr"});
}

} // namespace
} // namespace relief::test

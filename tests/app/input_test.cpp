// Files that are missing, damaged or do not fit together; folders that cannot be written.
#include "program.h"

namespace relief::test {
namespace {

constexpr std::string_view kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";

/// A render of the cage with more options; the folder must hold nothing new afterwards.
void expectNoPicture(const std::string& cage, const Words& more, Failure failure, const Words& parts) {
    const TemporaryFolder folder;
    Words words = {"render", cage, "--size", "64,64", "-o", folder / "a.png"};
    words.insert(words.end(), more.begin(), more.end());
    expectRefused(relief(words), failure, parts);
    EXPECT_EQ(folder.fileCount(), 0u);
}

TEST(Inputs, thatAreMissingExitWith4) {
    const std::string cube = cagePath("cube");
    expectNoPicture("none.obj", {}, Failure::file, {"none.obj: cannot be read"});
    expectNoPicture(cube, {"--height", "none.exr"}, Failure::file, {"none.exr: cannot be read"});
    expectNoPicture(cube, {"--albedo", "none.png"}, Failure::file, {"none.png: cannot be read"});
    expectNoPicture(cube, {"--environment", "none.hdr"}, Failure::file, {"none.hdr: cannot be read"});
    expectRefused(relief({"info", "none.obj"}), Failure::file, {"none.obj: cannot be read"});
    expectRefused(relief({"info", "none.png"}), Failure::file, {"none.png: cannot be read"});
}

TEST(Inputs, thatAreFoldersExitWith4) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "folder.obj");
    expectNoPicture(folder / "folder.obj", {}, Failure::file, {"folder.obj: cannot be read"});
    expectNoPicture(cagePath("cube"), {"--height", folder.path.string()}, Failure::file, {folder.path.string()});
}

TEST(Inputs, ofGarbageExitWith3AndNameTheFile) {
    const TemporaryFolder folder;
    std::string noise;
    for (unsigned i = 0; i < 4000; ++i) noise += char((i * i * 2654435761u) >> 13);
    putFile(folder / "noise.obj", noise);
    putFile(folder / "noise.png", noise);
    putFile(folder / "cut.png", "\x89PNG\r\n\x1a\n and then nothing");
    putFile(folder / "empty.obj", "");
    const std::string cube = cagePath("cube");
    expectNoPicture(folder / "noise.obj", {}, Failure::input, {folder / "noise.obj:1:"});
    expectNoPicture(folder / "empty.obj", {}, Failure::input, {folder / "empty.obj"});
    expectNoPicture(cube, {"--height", folder / "noise.png"}, Failure::input, {folder / "noise.png"});
    expectNoPicture(cube, {"--height", folder / "cut.png"}, Failure::input, {folder / "cut.png"});
    expectNoPicture(cube, {"--albedo", folder / "noise.png"}, Failure::input, {folder / "noise.png"});
    expectNoPicture(cube, {"--environment", folder / "cut.png"}, Failure::input, {folder / "cut.png"});
    expectRefused(relief({"info", folder / "noise.png"}), Failure::input, {folder / "noise.png"});
}

TEST(Inputs, withABadLineNameIt) {
    const TemporaryFolder folder;
    putFile(folder / "a.obj", "v 0 0 0\nv 1 0 0\n\nf 1 2 9\n");
    expectNoPicture(folder / "a.obj", {}, Failure::input, {folder / "a.obj:4:", "9"});
    expectRefused(relief({"info", folder / "a.obj"}), Failure::input, {folder / "a.obj:4:"});
}

TEST(Inputs, thatDoNotFitTogetherAreRefused) {
    const TemporaryFolder folder;
    writeImage(folder / "h.exr", sineImage(16, 1), SampleType::real);
    putFile(folder / "triangle.obj", kTriangle);
    const std::string cube = cagePath("cube"), map = folder / "h.exr";
    expectNoPicture(cube, {"--height", map, "--channel", "9"}, Failure::input, {map, "channel 9"});
    expectNoPicture(cube, {"--albedo", map}, Failure::input, {map, "3 channels"});
    expectNoPicture(cube, {"--environment", map}, Failure::input, {map});
    expectNoPicture(cube, {"--scheme", "loop"}, Failure::input, {cube, "loop", "triangles"});
    expectNoPicture(cube, {"--scheme", "none", "--height", map}, Failure::usage, {cube, "--scheme"});
    expectNoPicture(folder / "triangle.obj", {"--height", map}, Failure::usage, {"triangle.obj", "--scheme"});
    expectDone(relief({"render", folder / "triangle.obj", "--height", map, "-o", folder / "a.png"},
                      "--scheme loop --size 64,64 --rate 4"));
}

TEST(Inputs, environmentsAreTwiceAsWideAsHigh) {
    const TemporaryFolder folder;
    Image image{17, 8, 3, std::vector<float>(17 * 8 * 3, 0.5f)};
    writeImage(folder / "sky.exr", image, SampleType::real);
    expectNoPicture(cagePath("cube"), {"--environment", folder / "sky.exr"}, Failure::input,
                    {folder / "sky.exr", "twice as wide as high", "17 x 8"});
}

TEST(Inputs, withNonFiniteTexelsNameTheTexel) {
    const TemporaryFolder folder;
    Image image = sineImage(16, 1);
    *image.at(3, 2) = std::numeric_limits<float>::quiet_NaN();
    writeImage(folder / "h.exr", image, SampleType::real);
    expectNoPicture(cagePath("cube"), {"--height", folder / "h.exr"}, Failure::input, {"column 3", "row 2"});
}

TEST(Inputs, devicesThatAreNotThereExitWith5) {
    expectNoPicture(cagePath("cube"), {"--device", "abacus"}, Failure::device, {"abacus", "relief info --devices"});
}

TEST(Outputs, thatCannotBeWrittenExitWith4AndLeaveNothing) {
    const TemporaryFolder folder;
    putFile(folder / "file", "");
    std::filesystem::create_directory(folder / "folder.png");
    for (const std::string& target : {folder / "none/a.png", folder / "file/a.png", folder / "folder.png"})
        expectRefused(relief({"render", cagePath("cube"), "-o", target}, "--size 64,64 --rate 2"), Failure::file,
                      {target});
    putFile(folder / "points.csv", "0,0.5,0.5\n");
    expectRefused(relief({"sample", cagePath("cube"), "--at", folder / "points.csv", "-o", folder / "none/a.csv"}),
                  Failure::file, {folder / "none/a.csv"});
    expectRefused(relief({"export", cagePath("cube"), "-o", folder / "none/a.ply"}, "--rate 2"), Failure::file,
                  {folder / "none/a.ply"});
    EXPECT_EQ(folder.fileCount(), 3u);
}

// Nobody waits for a result that has nowhere to go: the output is tried before any input is read.
TEST(Outputs, thatCannotBeWrittenAreReportedFirst) {
    const TemporaryFolder folder;
    const auto refuse = [&](Words words, const std::string& target) {
        words.insert(words.end(), {"none.obj", "-o", target});
        expectRefused(relief(words), Failure::file, {target});
    };
    refuse({"render"}, folder / "none/a.png");
    refuse({"export"}, folder / "none/a.ply");
    refuse({"sample", "--at", "none.csv"}, folder / "none/a.csv");
    for (const Words& words :
         {Words{"render", "none.obj", "-o", folder / "a.png"}, Words{"export", "none.obj", "-o", folder / "a.ply"},
          Words{"sample", "none.obj", "--at", "none.csv", "-o", folder / "a.csv"}})
        expectRefused(relief(words), Failure::file, {"none."});
    EXPECT_EQ(folder.fileCount(), 0u);
}

TEST(Outputs, keepTheOldPictureWhenSomethingFails) {
    const TemporaryFolder folder;
    putFile(folder / "a.png", "old");
    expectRefused(relief({"render", cagePath("cube"), "-o", folder / "a.png"}, "--size 64,64 --scheme loop"),
                  Failure::input, {"loop"});
    EXPECT_EQ(readFile(folder / "a.png"), "old");
    EXPECT_EQ(folder.fileCount(), 1u);
}

} // namespace
} // namespace relief::test

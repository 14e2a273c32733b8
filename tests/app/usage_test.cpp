// Answers to those who ask for help or mistype.
#include "program.h"

namespace relief::test {
namespace {

const Words kVerbs = {"render", "animate", "view", "export", "sample", "check", "normal-map", "height-map", "info"};

TEST(Help, ofEveryVerbShowsExamples) {
    for (const std::string& verb : kVerbs) {
        const Outcome outcome = relief({verb, "--help"});
        EXPECT_EQ(outcome.exitCode, 0);
        EXPECT_EQ(outcome.err, "");
        EXPECT_TRUE(contains(outcome.out, "example")) << outcome.out;
        EXPECT_TRUE(contains(outcome.out, "\n  relief " + verb + " ")) << outcome.out;
    }
}

TEST(Help, listsVerbsAndExitCodes) {
    const Outcome outcome = relief({"--help"});
    EXPECT_EQ(outcome.exitCode, 0);
    for (const std::string& verb : kVerbs) EXPECT_TRUE(contains(outcome.out, "\n  " + verb + " ")) << verb;
    EXPECT_TRUE(contains(outcome.out, "exit codes: 0 done"));
}

// An option that is parsed but described nowhere would be a secret.
TEST(Help, namesEveryOption) {
    const std::string render = relief({"render", "--help"}).out;
    for (const char* option :
         {"--scheme",    "--isolation", "--height",      "--scale",      "--mid",         "--channel",   "--path",
          "--rate",      "--normal",    "--edge-pixels", "--size",       "--azimuth",     "--elevation", "--distance",
          "--look-at",   "--fov",       "--albedo",      "--light",      "--environment", "--show",      "--json",
          "--quiet",     "--verbose",   "--progress",    "--no-shadows", "--background",  "--device",    "--wrap",
          "--roughness", "--color",     "--transparent", "--spacing",    "--memory"})
        EXPECT_TRUE(contains(render, option)) << option;
    const std::string mesh = relief({"export", "--help"}).out;
    for (const char* option : {"--scheme", "--height", "--rate", "--edge-pixels", "--spacing", "--memory", "--normal",
                               "--size", "--azimuth", "--look-at", "--device", "--json"})
        EXPECT_TRUE(contains(mesh, option)) << option;
}

TEST(Version, isTheProjects) { EXPECT_EQ(relief({"--version"}).out, std::string("relief ") + RELIEF_VERSION + "\n"); }

TEST(Usage, unknownWordsAreAnsweredWithTheNearestOne) {
    const std::pair<const char*, const char*> cases[] = {
        {"rendr a.obj -o a.png", "did you mean render?"},
        {"sampel a.obj", "did you mean sample?"},
        {"--verison", "did you mean --version?"},
        {"render a.obj -o a.png --rte 4", "did you mean --rate?"},
        {"render a.obj -o a.png --hieght=map.exr", "did you mean --height?"},
        {"sample a.obj -o a.csv --at p.csv --isolaton 3", "did you mean --isolation?"},
        {"info --device", "did you mean --devices?"},
    };
    for (const auto& [line, answer] : cases) expectRefused(relief({}, line), Failure::usage, {answer});
}

TEST(Usage, unknownValuesAreAnsweredWithAllAndTheNearestOne) {
    const std::pair<const char*, const char*> cases[] = {{"--scheme catmrak", "did you mean catmark?"},
                                                         {"--path grids", "did you mean grid?"},
                                                         {"--spacing fractionl", "did you mean fractional?"},
                                                         {"--normal firstorder", "did you mean first-order?"},
                                                         {"--show wirefame", "did you mean wireframe?"},
                                                         {"--map-format unorm61", "did you mean unorm16?"},
                                                         {"--wrap clmap", "did you mean clamp?"},
                                                         {"--layers dpeth,uv", "did you mean depth?"},
                                                         {"--height-space strech", "did you mean stretch?"},
                                                         {"--interpolation liner", "did you mean linear?"},
                                                         {"--progress nevr", "did you mean never?"},
                                                         {"--scheme x", "catmark, loop, bilinear, none"},
                                                         {"--map-format x", "auto, float, half, unorm16, unorm8, bc4"}};
    for (const auto& [line, answer] : cases)
        expectRefused(relief({"render", cagePath("cube"), "-o", "never.png"}, line), Failure::usage, {answer});
}

TEST(Help, explainsEachValueOnALineOfItsOwn) {
    const std::string help = relief({"render", "--help"}).out;
    for (const char* line : {" dice: once per picture", " grid: by the vertex shader", " bc4: 4 bits per texel"})
        EXPECT_TRUE(contains(help, line)) << line;
    for (const char* text : {"(default: 1024,1024)", "(default: equal)", "(default: auto)", "(default: 2)"})
        EXPECT_TRUE(contains(help, text)) << text;
}

TEST(Help, fitsAScreenOf120Columns) {
    for (const std::string& verb : kVerbs) {
        std::istringstream help(relief({verb, "--help"}).out);
        for (std::string line; std::getline(help, line);) EXPECT_LE(line.size(), 120u) << verb << ": " << line;
    }
}

TEST(Usage, withoutAVerbNamesThem) {
    for (const char* line : {"", "--quiet", "zzzzzzz"}) expectRefused(relief({}, line), Failure::usage, kVerbs);
}

TEST(Usage, wrongOptionsAreOneLineWithTheOption) {
    const std::pair<const char*, const char*> cases[] = {
        {"--size 0,5", "--size"},
        {"--size 5", "--size"},
        {"--size 64,64,64", "--size"},
        {"--size 64x64", "--size"},
        {"--size 100000,64", "16384"},
        {"--edge-pixels 0", "--edge-pixels"},
        {"--edge-pixels -2", "--edge-pixels"},
        {"--rate 4 --edge-pixels 2", "--rate"},
        {"--rate x", "--rate"},
        {"--isolation 11", "0 to 10"},
        {"--isolation -1", "0 to 10"},
        {"--scheme cubic", "catmark"},
        {"--channel -1", "--channel"},
        {"--wrap mirror", "repeat"},
        {"--path dense", "grid"},
        {"--spacing odd", "fractional"},
        {"--memory 2X", "1M..1T, such as 512M or 2G"},
        {"--memory 12", "1M..1T"},
        {"--memory 2T", "1M..1T"},
        {"--memory -1G", "1M..1T"},
        {"--memory nan", "1M..1T"},
        {"--memory infG", "1M..1T"},
        {"--memory G", "1M..1T"},
        {"--normal flat", "first-order"},
        {"--show everything", "wireframe"},
        {"--elevation 91", "-90..90"},
        {"--fov 0", "1..150"},
        {"--distance 0", "--distance"},
        {"--look-at 1,2", "--look-at"},
        {"--light 40", "--light"},
        {"--color 1,1,2", "--color"},
        {"--roughness -1", "0..1"},
        {"--background 1,0,0 --transparent", "--transparent"},
        {"--progress sometimes", "always"},
        {"--height", "--height"},
        {"second.obj", "second.obj"},
    };
    for (const auto& [line, word] : cases)
        expectRefused(relief({"render", cagePath("cube"), "-o", "never.png"}, line), Failure::usage, {word});
}

TEST(Usage, nonFiniteNumbersAreRefused) {
    const std::pair<const char*, const char*> cases[] = {
        {"--edge-pixels", "nan"}, {"--scale", "inf"},       {"--mid", "-nan"},   {"--azimuth", "1e999"},
        {"--elevation", "nan"},   {"--distance", "inf"},    {"--fov", "thirty"}, {"--roughness", "nan"},
        {"--light", "nan,3"},     {"--look-at", "0,inf,0"}, {"--color", "0,0,"}};
    for (const auto& [option, value] : cases)
        expectRefused(relief({"render", cagePath("cube"), "-o", "never.png", option, value}), Failure::usage, {option});
}

TEST(Usage, optionsGivenTwiceAreNamed) {
    const std::pair<const char*, const char*> cases[] = {
        {"--rate 4 --rate 5", "--rate is given twice"},
        {"--rate=4 --rate 5 --rate 6", "--rate is given twice"},
        {"--size 8,8 --size 9,9", "--size is given twice"},
        {"--height a.exr --height b.exr", "--height is given twice"},
        {"--progress never --progress always", "--progress is given twice"},
        {"--memory 1G --memory 2G", "--memory is given twice"},
        {"-o b.png", "-o is given twice"},
        {"-ob.png", "-o is given twice"},
        {"--output b.png", "--output is given twice"},
    };
    for (const auto& [line, words] : cases)
        expectRefused(relief({"render", cagePath("cube"), "-o", "never.png"}, line), Failure::usage, {words});
}

TEST(Usage, missingOptionsAreNamed) {
    expectRefused(relief({"render"}), Failure::usage, {"cage"});
    expectRefused(relief({"render", cagePath("cube")}), Failure::usage, {"--output"});
    expectRefused(relief({"export", cagePath("cube")}), Failure::usage, {"--output"});
    expectRefused(relief({"sample", cagePath("cube"), "-o", "never.csv"}), Failure::usage, {"--at"});
    expectRefused(relief({"info"}), Failure::usage, {"--devices"});
}

TEST(Usage, wordsWithLineBreaksStillMakeOneLine) {
    expectRefused(relief({"render", "two\nlines.obj", "-o", "never.png"}), Failure::file, {"two lines.obj"});
    expectRefused(relief({"info", "x", "--two\nlines"}), Failure::usage, {"lines"});
}

// The tessellator's limit is a property of the device; the grid's is higher.
TEST(Usage, ratesThatThePathCannotDoAreRefusedWithTheRange) {
    const TemporaryFolder folder;
    const Words words = {"render", cagePath("cube"), "--size", "64,64", "-o", folder / "a.png"};
    for (const char* rate : {"0", "-1", "65", "2147483647"})
        expectRefused(relief(words, std::string("--path tessellation --rate ") + rate), Failure::usage, {"1..64"});
    expectRefused(relief(words, "--path grid --rate 1025"), Failure::usage, {"1..1024"});
    EXPECT_EQ(folder.fileCount(), 0u);
    expectDone(relief(words, "--path grid --rate 65"));
}

TEST(Usage, memoryThatADicedMeshPassesIsRefused) {
    const TemporaryFolder folder;
    expectRefused(relief({"render", cagePath("cube"), "-o", folder / "a.png"}, "--path dice --rate 200 --memory 1M"),
                  Failure::device, {"1.0 MB are allowed", "--memory"});
    EXPECT_EQ(folder.fileCount(), 0u);
}

TEST(Usage, picturesOfUnknownKindsAreRefusedBeforeTheyAreDrawn) {
    const TemporaryFolder folder;
    for (const char* name : {"a.jpg", "a", "a.png.gz", ".png/"})
        expectRefused(relief({"render", "no-such.obj", "-o", folder / name}), Failure::usage, {".png or .exr"});
    EXPECT_EQ(folder.fileCount(), 0u);
}

} // namespace
} // namespace relief::test

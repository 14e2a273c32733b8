// What goes to stdout and stderr: JSON, summaries, warnings, progress, silence.
#include "program.h"

namespace relief::test {
namespace {

class Printed : public ::testing::Test {
protected:
    TemporaryFolder folder_;
    Words render_ = {"render", cagePath("cube"), "--size", "64,64", "--rate", "4", "-o", folder_ / "a.png"};
};

TEST_F(Printed, isOneLineOnStderrPerRender) {
    const Outcome outcome = relief(render_);
    expectDone(outcome);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, folder_ / "a.png")) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "triangles")) << outcome.err;
}

TEST_F(Printed, countsInJsonWhatWasDrawn) {
    const nlohmann::json json = jsonOf(relief(render_, "--json --path grid"));
    EXPECT_EQ(json.at("picture"), folder_ / "a.png");
    EXPECT_EQ(json.at("faces"), 6);
    EXPECT_EQ(json.at("triangles"), 6 * 4 * 4 * 2);
    EXPECT_EQ(json.at("vertices"), 6 * 4 * 4 + 2); // Euler: a closed surface without handles
    EXPECT_EQ(json.at("max_rate"), 4);
    EXPECT_EQ(json.at("map_bytes"), 0);
    EXPECT_EQ(json.at("dense_bytes"), 32 * 98 + 12 * 192);
    EXPECT_FALSE(json.at("device").get<std::string>().empty());
    for (const char* key : {"draws", "cage_bytes", "device_bytes", "load_ms", "surface_ms", "table_ms", "rate_ms",
                            "shadow_ms", "color_ms", "light_ms", "frame_ms"})
        EXPECT_TRUE(json.at(key).is_number()) << key;
}

TEST_F(Printed, describesTheMapInJson) {
    writeImage(folder_ / "h.exr", sineImage(16, 1), SampleType::real);
    const nlohmann::json json = jsonOf(relief(render_, "--json --scale 0.1 --height " + folder_ / "h.exr"));
    EXPECT_EQ(json.at("map_bytes"), (16 * 16 + 8 * 8 + 4 * 4 + 2 * 2 + 1 + 1) * 4); // with its mips, in pairs of words
}

TEST_F(Printed, isNothingWithQuiet) {
    writeImage(folder_ / "eight.png", sineImage(16, 1), SampleType::uint8);
    const std::string map = "--scale 0.1 --height " + folder_ / "eight.png";
    const Outcome loud = relief(render_, map);
    EXPECT_TRUE(contains(loud.err, "warning: ") && contains(loud.err, "8-bit")) << loud.err;
    const Outcome quiet = relief(render_, map + " -q");
    expectDone(quiet);
    EXPECT_EQ(quiet.err, "");
    putFile(folder_ / "points.csv", "0,0.5,0.5\n");
    const Outcome sample =
        relief({"sample", cagePath("cube"), "--at", folder_ / "points.csv", "-o", folder_ / "f.csv", "-q"});
    expectDone(sample);
    EXPECT_EQ(sample.err, "");
}

TEST_F(Printed, hasTheTimeOfEveryStepWithVerbose) {
    const Outcome outcome = relief(render_, "-v");
    expectDone(outcome);
    for (const char* step : {"load", "surface", "shadow", "color", "draws"})
        EXPECT_TRUE(contains(outcome.err, step)) << outcome.err;
}

TEST_F(Printed, hasProgressOnlyWhereItIsAskedFor) {
    EXPECT_FALSE(contains(relief(render_).err, "%")); // stderr is no terminal here
    EXPECT_TRUE(contains(relief(render_, "--progress always").err, "100 %"));
    EXPECT_FALSE(contains(relief(render_, "--progress never").err, "%"));
}

} // namespace
} // namespace relief::test

// relief doctor: its reports, its picture, its exit codes, and what it refuses.
#include "program.h"

namespace relief::test {
namespace {

struct DoctorVerb : testing::Test {
    TemporaryFolder folder;
    const std::string torus = cagePath("torus"), good = folder / "good.exr", raised = folder / "raised.exr";

    void SetUp() override {
        Image image = sineImage(64, 2);
        for (float& texel : image.texels) texel *= 0.02f;
        writeImage(good, image, SampleType::real);
        for (float& texel : image.texels) texel += 0.1f;
        writeImage(raised, image, SampleType::real);
    }
};

TEST_F(DoctorVerb, reportsEachMapAndEndsWithItsCode) {
    const nlohmann::json json = jsonOf(relief({"doctor", torus, good, "--json"}));
    ASSERT_EQ(json.size(), 1u);
    EXPECT_EQ(json[0].at("map"), good);
    EXPECT_TRUE(json[0].at("findings").empty());
    EXPECT_EQ(json[0].at("settings").at("blender").at("Displacement node: Scale"), "1");
    const Outcome both = relief({"doctor", torus, good, raised});
    EXPECT_EQ(both.exitCode, int(Failure::check));
    EXPECT_TRUE(contains(both.out, "nothing is wrong")) << both.out;
    EXPECT_TRUE(contains(both.out, "fault midlevel")) << both.out;
    EXPECT_TRUE(contains(both.err, "1 fault in 1 of 2 maps")) << both.err;
    const Outcome ill = relief({"doctor", torus, raised, "--json"});
    EXPECT_EQ(ill.exitCode, int(Failure::check));
    const nlohmann::json finding = nlohmann::json::parse(ill.out)[0].at("findings").at(0);
    EXPECT_EQ(finding.at("kind"), "midlevel");
    EXPECT_EQ(finding.at("severity"), "fault");
    expectDone(relief({"doctor", torus, raised, "-q", "--mid", "0.1"}));
}

TEST_F(DoctorVerb, drawsThePictureAlsoWhereThereAreFaults) {
    const Outcome outcome = relief({"doctor", torus, raised, "-q", "-o", folder / "f.png", "--side", "128"});
    EXPECT_EQ(outcome.exitCode, int(Failure::check));
    EXPECT_EQ(readImageInfo(folder / "f.png").width, 128);
}

TEST_F(DoctorVerb, refusesWhatItCannotExamine) {
    expectRefused(relief({"doctor", torus}), Failure::usage, {"maps"});
    expectRefused(relief({"doctor", torus, good, raised, "-o", folder / "f.png"}), Failure::usage, {"2 are named"});
    expectRefused(relief({"doctor", torus, good, "-o", folder / "f.exr"}), Failure::usage, {"f.exr", ".png"});
    expectRefused(relief({"doctor", torus, good, "-o", torus}), Failure::usage, {"torus.obj"});
    expectRefused(relief({"doctor", torus, folder / "none.exr"}), Failure::file, {"none.exr"});
    putFile(folder / "text.png", "no picture");
    expectRefused(relief({"doctor", torus, good, folder / "text.png"}), Failure::input, {"text.png"});
    EXPECT_EQ(folder.fileCount(), 3u) << "no picture is written";
}

} // namespace
} // namespace relief::test

// relief animate, as a user runs it.
#include <thread>

#include "cage/cage.h"
#include "gltf.h"
#include "program.h"

namespace relief::test {
namespace {

using namespace std::chrono_literals;

const std::string kTwist = "twist(axis=y, angle=60*sin(pi*t))";

class Animate : public ::testing::Test {
protected:
    TemporaryFolder folder_;
    Words words_ = {"animate", cagePath("torus"), "--size", "48,48", "--rate", "3", "--fps", "10"};

    /// The words with more behind them.
    [[nodiscard]] Words with(Words more) const {
        Words all = words_;
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    [[nodiscard]] Words twist(const std::string& frames, const std::string& target) const {
        return with({"--deform", kTwist, "--frames", frames, "-o", folder_ / target});
    }
};

// --- frames --------------------------------------------------------------------------------------------------------

TEST_F(Animate, namesFramesByTheirNumbers) {
    expectDone(relief(twist("8:10x2,0", "f.{frame:4}.png")));
    for (const char* name : {"f.0008.png", "f.0010.png", "f.0000.png"})
        EXPECT_EQ(readImageInfo(folder_ / name).width, 48) << name;
    EXPECT_EQ(folder_.fileCount(), 3u);
}

TEST_F(Animate, drawsAFrameTheSameWhicheverRangeItIsIn) {
    for (const std::string path : {"tessellation", "grid", "dice"}) {
        expectDone(relief(twist("1:4", path + "_range.{frame}.exr"), "--path " + path));
        expectDone(relief(twist("3", path + "_alone.{frame}.exr"), "--path " + path));
        const std::string alone = readFile(folder_ / (path + "_alone.3.exr"));
        EXPECT_EQ(readFile(folder_ / (path + "_range.3.exr")), alone) << path;
        EXPECT_NE(readFile(folder_ / (path + "_range.2.exr")), alone) << path;
    }
}

TEST_F(Animate, movesOnTheDeviceAsRenderDoesOnTheHost) {
    expectDone(relief(twist("3", "f.{frame}.exr"), "--azimuth 20 --distance 12 --look-at 0,0,0"));
    expectDone(relief({"render", cagePath("torus"), "--size", "48,48", "--rate", "3", "--deform", kTwist, "-o",
                       folder_ / "still.exr"},
                      "--time 0.3 --azimuth 20 --distance 12 --look-at 0,0,0"));
    const Image moved = readImage(folder_ / "f.3.exr"), still = readImage(folder_ / "still.exr");
    double squares = 0;
    for (std::size_t i = 0; i < moved.texels.size(); ++i) squares += std::pow(moved.texels[i] - still.texels[i], 2);
    EXPECT_LT(std::sqrt(squares / double(moved.texels.size())), 0.01); // shadow maps differ in what they cover
}

TEST_F(Animate, uploadsTwelveBytesPerPointOfTheCage) {
    const nlohmann::json json = jsonOf(relief(twist("0:1", "f.{frame}.png"), "--json"));
    ASSERT_EQ(json.at("frames").size(), 2u);
    const std::size_t points = 128;
    EXPECT_EQ(jsonOf(relief({"info", cagePath("torus"), "--json"}))[0].at("vertices"), points);
    EXPECT_EQ(json.at("frames")[0].at("uploaded_bytes"), 12 * points);
}

TEST_F(Animate, takesAllKeysWithoutBeingAsked) {
    expectDone(relief(twist("2:5", "twist.pc2")));
    const nlohmann::json json =
        jsonOf(relief(with({"--cache", folder_ / "twist.pc2", "-o", folder_ / "f.{frame}.png"}), "--json"));
    ASSERT_EQ(json.at("frames").size(), 4u);
    EXPECT_EQ(json.at("frames")[0].at("frame"), 2);
}

TEST_F(Animate, writesCachesThatGiveTheSameFrames) {
    expectDone(relief(twist("3", "direct.{frame}.exr"), "--distance 12 --look-at 0,0,0"));
    for (const std::string cache : {"twist.pc2", "twist.mdd"}) {
        expectDone(relief(twist("1:4", cache)));
        expectDone(relief(with({"--cache", folder_ / cache, "--frames", "3", "-o", folder_ / (cache + ".{frame}.exr")}),
                          "--distance 12 --look-at 0,0,0"));
        EXPECT_EQ(readFile(folder_ / (cache + ".3.exr")), readFile(folder_ / "direct.3.exr")) << cache;
    }
}

TEST_F(Animate, turnsOnceAround) {
    expectDone(relief(with({"--turntable", "8", "--frames", "1,5,9", "-o", folder_ / "f.{frame}.exr"})));
    // The eye of frame 9 is that of frame 1 but for rounding of the angle.
    const Image first = readImage(folder_ / "f.1.exr"), half = readImage(folder_ / "f.5.exr"),
                last = readImage(folder_ / "f.9.exr");
    int flippedCount = 0; // a sample of an outline or a shadow may fall to the other side of it by that rounding
    double across = 0;
    for (std::size_t i = 0; i < first.texels.size(); ++i) {
        flippedCount += std::abs(first.texels[i] - last.texels[i]) > 0.02f;
        across = std::max(across, double(std::abs(first.texels[i] - half.texels[i])));
    }
    EXPECT_LE(flippedCount, 8); // values of two pixels of 2304
    EXPECT_GT(across, 0.05);
}

/// The torus on two joints, of which the second one turns by 60 degrees within a second.
GltfFile skinnedTorus(const Cage& cage) {
    GltfFile file;
    std::vector<std::uint32_t> triangles;
    for (std::size_t i = 0; i < cage.corners.size(); i += 4)
        for (const std::size_t k : {0, 1, 2, 0, 2, 3}) triangles.push_back(cage.corners[i + k]);
    file.addMesh(cage.positions, triangles);
    std::vector<std::uint8_t> joints;
    std::vector<vec4> weights;
    for (const vec3& p : cage.positions) {
        const float share = std::clamp(0.5f + 0.4f * p.x, 0.0f, 1.0f);
        joints.insert(joints.end(), {0, 1, 0, 0});
        weights.emplace_back(1 - share, share, 0, 0);
    }
    const int jointsAt = file.add(joints, "VEC4", kUnsignedByte), weightsAt = file.add(weights);
    file.attributes()["JOINTS_0"] = jointsAt;
    file.attributes()["WEIGHTS_0"] = weightsAt;
    file.addNode({{"mesh", 0}, {"skin", 0}});
    file.addNode({{"name", "still"}, {"children", {2}}});
    file.addNode({{"name", "turning"}}, false);
    file.json["skins"] = {{{"joints", {1, 2}}}};
    file.addChannel(2, "rotation", file.add(std::vector<float>{0, 1}),
                    file.add(std::vector<vec4>{{0, 0, 0, 1}, {0, 0, 0.5f, 0.8660254f}}));
    return file;
}

TEST_F(Animate, skinsOnTheDeviceWhatASkinSays) {
    putFile(folder_ / "skin.glb", skinnedTorus(readCage(cagePath("torus"))).glb());
    const auto skin = [&](const std::string& frames, const std::string& target) {
        return with({"--skin", folder_ / "skin.glb", "--frames", frames, "-o", folder_ / target});
    };
    const std::string held = "--distance 14 --look-at 0,0,0";
    const nlohmann::json json = jsonOf(relief(skin("0,8", "skin.{frame}.exr"), held + " --json"));
    EXPECT_EQ(json.at("frames")[1].at("uploaded_bytes"), 2 * 12 * 4); // two joints, three rows of four
    // The same by way of positions that the processor has posed.
    expectDone(relief(skin("0:8", "cache.pc2")));
    expectDone(
        relief(with({"--cache", folder_ / "cache.pc2", "--frames", "8", "-o", folder_ / "cache.{frame}.exr"}), held));
    const Image rest = readImage(folder_ / "skin.0.exr"), moved = readImage(folder_ / "skin.8.exr"),
                sent = readImage(folder_ / "cache.8.exr");
    double same = 0, apart = 0;
    for (std::size_t i = 0; i < moved.texels.size(); ++i) {
        same += std::pow(moved.texels[i] - sent.texels[i], 2);
        apart += std::pow(moved.texels[i] - rest.texels[i], 2);
    }
    EXPECT_LT(std::sqrt(same / double(moved.texels.size())), 0.005);
    EXPECT_GT(std::sqrt(apart / double(moved.texels.size())), 0.05);
}

// --- going on ------------------------------------------------------------------------------------------------------

TEST_F(Animate, resumesWithTheFramesThatAreMissing) {
    putFile(folder_ / "f.2.png", "this frame was there");
    const nlohmann::json json = jsonOf(relief(twist("1:3", "f.{frame}.png"), "--resume --json"));
    EXPECT_EQ(json.at("skipped_frames"), 1);
    EXPECT_EQ(json.at("frames").size(), 2u);
    EXPECT_EQ(readFile(folder_ / "f.2.png"), "this frame was there");
    EXPECT_EQ(readImageInfo(folder_ / "f.3.png").width, 48);
}

TEST_F(Animate, leavesOnlyWholeFramesWhenInterruptedAndGoesOn) {
    const Words all = twist("1:400", "f.{frame:3}.png");
    Program program(all);
    for (int i = 0; i < 3000 && folder_.fileCount() < 3; ++i) std::this_thread::sleep_for(10ms);
    program.signal(SIGINT);
    EXPECT_EQ(program.wait().exitCode, 130);
    const std::size_t count = folder_.fileCount();
    ASSERT_GE(count, 2u);
    ASSERT_LT(count, 400u);
    for (const auto& entry : std::filesystem::directory_iterator(folder_.path))
        EXPECT_EQ(readImage(entry.path().string()).width, 48) << entry.path();
    const nlohmann::json json =
        jsonOf(relief(twist(fmt::format("1:{}", count + 1), "f.{frame:3}.png"), "--resume --json"));
    EXPECT_EQ(json.at("skipped_frames"), count);
    EXPECT_EQ(folder_.fileCount(), count + 1);
}

TEST_F(Animate, reportsFramesPerSecondAndTheTimeLeft) {
    const Outcome outcome = relief(twist("0:1", "f.{frame}.png"), "--progress always");
    EXPECT_TRUE(contains(outcome.err, "frames/s")) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "left")) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "2 frames in")) << outcome.err;
}

// --- clips ---------------------------------------------------------------------------------------------------------

bool hasFfmpeg() { return std::system("ffmpeg -version >/dev/null 2>&1") == 0; }

TEST_F(Animate, makesClips) {
    if (!hasFfmpeg()) GTEST_SKIP() << "ffmpeg is not installed";
    const std::map<std::string, std::string> magics{
        {"a.mp4", "ftyp"}, {"a.webm", "webm"}, {"a.gif", "GIF89a"}, {"a.webp", "WEBP"}};
    for (const auto& [name, magic] : magics) {
        expectDone(relief(twist("0:2", name)));
        EXPECT_TRUE(contains(readFile(folder_ / name).substr(0, 64), magic)) << name;
    }
    EXPECT_EQ(folder_.fileCount(), magics.size());
}

TEST_F(Animate, namesFfmpegWhereItIsMissing) {
    const std::string path = std::getenv("PATH");
    setenv("PATH", "/nowhere", 1);
    const Outcome outcome = relief(twist("0:2", "a.mp4"));
    setenv("PATH", path.c_str(), 1);
    expectRefused(outcome, Failure::file, {"ffmpeg", "not installed", "frame.{frame:4}.png"});
    EXPECT_EQ(folder_.fileCount(), 0u);
}

// --- refusals ------------------------------------------------------------------------------------------------------

TEST_F(Animate, refusesOptionsThatMakeNoSense) {
    const auto refuse = [&](const Words& more, const Words& parts) {
        expectRefused(relief(with(more)), Failure::usage, parts);
    };
    const std::string target = folder_ / "f.{frame}.png";
    refuse({"-o", target}, {"nothing moves", "--turntable"});
    refuse({"--turntable", "4", "-o", folder_ / "f.png"}, {"f.png", "{frame"});
    refuse({"--turntable", "4", "-o", folder_ / "f.{frame}.bmp"}, {"f.{frame}.bmp", ".mp4"});
    refuse({"--turntable", "4", "--frames", "1:", "-o", target}, {"--frames 1:", "character 3"});
    refuse({"--turntable", "4", "--frames", "1:9x0", "-o", target}, {"step of 0"});
    refuse({"--turntable", "4", "--frames", "1:2000000000", "-o", target}, {"more than 1000000 frames"});
    refuse({"--deform", "twirl(angle=3)", "-o", target}, {"twirl", "twist"});
    refuse({"--turntable", "4", "--layers", "motion", "-o", target}, {"layers", ".exr"});
    refuse({"--deform", kTwist, "--frames", "1:9x2", "-o", folder_ / "a.pc2"}, {"every frame"});
    refuse({"--turntable", "4", "--resume", "-o", folder_ / "a.gif"}, {"--resume"});
    for (const char* target : {"a.gif", "a.webm", "a.pc2"})
        refuse({"--deform", kTwist, "--layers", "all", "-o", folder_ / target}, {target, "layers", ".exr"});
    EXPECT_EQ(folder_.fileCount(), 0u);
}

TEST_F(Animate, refusesCachesThatAreNotWhole) {
    expectDone(relief(twist("1:4", "good.pc2")));
    const std::string good = readFile(folder_ / "good.pc2");
    const auto refuse = [&](std::string bytes, const Words& parts) {
        putFile(folder_ / "bad.pc2", bytes);
        expectRefused(relief(with({"--cache", folder_ / "bad.pc2", "-o", folder_ / "f.{frame}.png"})), Failure::input,
                      parts);
    };
    refuse(good.substr(0, good.size() - 4), {"bad.pc2"});
    refuse("PNG" + good, {"bad.pc2"});
    std::string swapped = good;
    std::reverse(swapped.begin() + 16, swapped.begin() + 20); // the point count
    refuse(swapped, {"bad.pc2"});
    EXPECT_EQ(folder_.fileCount(), 2u);
}

// --- layers --------------------------------------------------------------------------------------------------------

TEST_F(Animate, writesLayersAsChannels) {
    expectDone(relief(twist("3", "f.{frame}.exr"), "--layers all"));
    const std::vector<std::string> names = readImageInfo(folder_ / "f.3.exr").channelNames;
    for (const char* name :
         {"R", "G", "B", "A", "Z", "N.X", "N.Y", "N.Z", "face.ID", "uv.U", "uv.V", "height.H", "motion.X", "motion.Y"})
        EXPECT_NE(std::ranges::find(names, name), names.end()) << name;
    expectDone(relief(twist("3", "g.{frame}.exr"), "--layers depth,uv"));
    EXPECT_EQ(readImageInfo(folder_ / "g.3.exr").channels, 4 + 3);
}

} // namespace
} // namespace relief::test

// The window: sessions are played, and what they leave is compared with the other verbs.
#include "display.h"
#include "window_manager.h"

namespace relief::test {
namespace {

// Minimised it draws nothing, whatever happens; once it is back it shows what has happened.
TEST(Window, showsThePictureCodeForCodeAlsoAfterItWasMinimised) {
    RELIEF_DISPLAY;
    const WindowManager manager;
    const TemporaryFolder folder;
    const std::string session =
        writeSession(folder, "session",
                     "key Tab\nrest\nminimise\nreport\nkey N\nwait 0.6\nreport\nrestore\nrest\nreport\nscreenshot " +
                         (folder / "a.png") + "\nkey Escape\nrest\nwait 2\nclose\n");
    Program window({"view", cagePath("torus"), "--size", "320,240", "--play", session});
    // While it waits, the screen shows what was written.
    std::size_t different = 1;
    for (int i = 0; i < 1000 && different > 0; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        if (!std::filesystem::exists(folder / "a.png")) continue;
        const Image written = readImage(folder / "a.png");
        const std::vector<std::uint8_t> screen = display.pixels(320, 240);
        different = 0;
        for (std::size_t k = 0; k < screen.size(); ++k) different += screen[k] != std::lround(255 * written.texels[k]);
    }
    EXPECT_EQ(different, 0u);
    const std::vector<nlohmann::json> reports = reportsOf(window.wait());
    ASSERT_EQ(reports.size(), 3u);
    EXPECT_EQ(reports[0]["minimised"], true);
    EXPECT_EQ(reports[1]["pictures"], reports[0]["pictures"]);
    EXPECT_EQ(reports[1]["frames"], reports[0]["frames"]);
    EXPECT_EQ(reports[2]["minimised"], false);
    EXPECT_GT(reports[2]["pictures"], reports[1]["pictures"]);
}

TEST(Window, writesWhatRenderWritesAfterEverythingThatAUserDoes) {
    RELIEF_DISPLAY;
    const TemporaryFolder folder;
    writeWaves(folder / "waves.png", 3);
    // Radiance: 8 x 4 pixels of red, green, blue and a shared exponent.
    writeFile(folder / "sky.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8\n" + std::string(128, '\x80'));
    writeFile(folder / "broken.png", "no picture");
    // Turned, moved, zoomed, lit; three files; a picture that cannot be read; all keys; another size; nothing at all.
    std::string lines = "rest\nkey Tab\nmove 90 50\npress left\nmove 110 60\nmove 120 65\nrelease left\nwheel 2\n"
                        "press right control\nmove 122 65\nrelease right\npress middle\nmove 125 60\nrelease "
                        "middle\npress left control\nmove 130 50\nrelease left\n"
                        "screenshot " +
                        (folder / "a.png") + "\nreport\n";
    for (const std::string& file : {folder / "waves.png", folder / "sky.hdr", cagePath("ball")})
        lines += "drop " + file + "\nrest\n";
    lines += "key +\nkey T\nkey D\nrest\nscreenshot " + (folder / "b.png") + "\nreport\n";
    lines += "drop " + (folder / "broken.png") + "\nrest\nreport\n";
    for (const char* key :
         {"F", "1", "3", "7", "5", "W", "W", "W", "H", "N", "N",      "N",    "N",     "N",   "N",   "V", "-",
          "V", "Z", "X", "X", "X", "X", "X", "X", "Z", "?", "Escape", "Left", "Space", "Tab", "Tab", "H"})
        lines += std::string("key ") + key + "\n";
    lines += "rest\nsize 150 130\nrest\nscreenshot " + (folder / "c.png") + "\nrest\nreport\nwait 1\nreport\nclose\n";
    const std::vector<nlohmann::json> reports =
        reportsOf(relief({"view", cagePath("torus"), "--size", "160,120", "--scale", "0.1", "--play",
                          writeSession(folder, "session", lines)}));
    ASSERT_EQ(reports.size(), 5u);

    // Each screenshot is the picture of the command line that the window names.
    expectSame(reports[0], folder / "a.png", folder);
    expectSame(reports[1], folder / "b.png", folder);
    expectSame(reports[3], folder / "c.png", folder);
    // The three files were shown; the broken one is an error, and what was shown stays.
    EXPECT_EQ(reports[1]["reloads"], 4);
    EXPECT_EQ(reports[1]["error"], "");
    EXPECT_TRUE(contains(reports[2]["error"], "broken.png")) << reports[2];
    EXPECT_EQ(reports[2]["command"], reports[1]["command"]);
    EXPECT_EQ(reports[2]["reloads"], 4);
    // A second in which nothing changes draws nothing.
    EXPECT_EQ(reports[4]["frames"], reports[3]["frames"]);
    EXPECT_EQ(reports[4]["pictures"], reports[3]["pictures"]);
}

TEST(Window, readsFilesAnewAndKeepsTheLastGoodOnes) {
    RELIEF_DISPLAY;
    const TemporaryFolder folder;
    writeWaves(folder / "waves.png", 2);
    const std::string session =
        writeSession(folder, "session",
                     "rest\nscreenshot " + (folder / "a.png") + "\nwait 2\nrest\nscreenshot " + (folder / "b.png") +
                         "\nreport\nwait 2\nrest\nscreenshot " + (folder / "c.png") + "\nreport\nclose\n");
    Program window({"view", cagePath("torus"), "--size", "160,120", "--height", folder / "waves.png", "--scale", "0.2",
                    "--play", session});
    EXPECT_TRUE(waitForFile(folder / "a.png"));
    writeWaves(folder / "waves.png", 5);
    EXPECT_TRUE(waitForFile(folder / "b.png"));
    writeFile(folder / "waves.png", "half of a picture");
    const std::vector<nlohmann::json> reports = reportsOf(window.wait());
    ASSERT_EQ(reports.size(), 2u);
    EXPECT_EQ(reports[0]["reloads"], 1);
    EXPECT_EQ(reports[0]["error"], "");
    EXPECT_FALSE(readFile(folder / "a.png") == readFile(folder / "b.png"));
    EXPECT_EQ(reports[1]["reloads"], 1);
    EXPECT_TRUE(contains(reports[1]["error"], "waves.png")) << reports[1];
    EXPECT_TRUE(readFile(folder / "b.png") == readFile(folder / "c.png"));
}

TEST(Window, showsTheFramesOfAnimate) {
    RELIEF_DISPLAY;
    const TemporaryFolder folder;
    const std::string lines = "rest\nframe 5\nrest\nscreenshot " + (folder / "a.png") +
                              "\nreport\nkey Right\nkey Right\nmove 200 100\npress left\nmove 180 100\nrelease left\n"
                              "rest\nscreenshot " +
                              (folder / "b.png") + "\nreport\nkey Space\nwait 1\nkey Space\nreport\nclose\n";
    const std::vector<nlohmann::json> reports =
        reportsOf(relief({"view", cagePath("torus"), "--size", "160,120", "--deform", "twist(axis=y, angle=60*sin(t))",
                          "--frames", "0:40", "--play", writeSession(folder, "session", lines)}));
    ASSERT_EQ(reports.size(), 3u);
    EXPECT_EQ(reports[0]["frame"], 5);
    expectSame(reports[0], folder / "a.png", folder);
    EXPECT_EQ(reports[1]["frame"], 7);
    expectSame(reports[1], folder / "b.png", folder);
    EXPECT_GT(reports[2]["frame"], 7);
    EXPECT_GT(reports[2]["pictures"], reports[1]["pictures"]);
}

TEST(Window, keepsItsMemoryOverThreeHundredFrames) {
    RELIEF_DISPLAY;
    const TemporaryFolder folder;
    // Everything is compiled; then two pictures by turns, with six looks at the memory; then frames of panels alone.
    std::string lines = "rest\nkey V\nrest\nkey V\nrest\n";
    for (int i = 0; i < 6; ++i) {
        for (int k = 0; k < 10; ++k) lines += "key V\nrest\n";
        lines += "report\n";
    }
    lines += "frames 300\nrest\nreport\nclose\n";
    writeSession(folder, "session", lines);
    // Without the validation layer, which keeps some kilobytes of every frame.
    const Outcome outcome =
        shell("RELIEF_VALIDATE=0 $RELIEF view " + cagePath("torus") + " --size 320,240 --no-shadows --play $IN/session",
              folder);
    const std::vector<nlohmann::json> reports = reportsOf(outcome);
    ASSERT_EQ(reports.size(), 7u);
    EXPECT_GE(reports[5]["pictures"].get<int>(), reports[0]["pictures"].get<int>() + 50);
    EXPECT_GE(reports[6]["frames"].get<int>(), reports[5]["frames"].get<int>() + 300);
    for (const nlohmann::json& report : reports) EXPECT_EQ(report["device_bytes"], reports[0]["device_bytes"]);
    // Mesa's CPU driver keeps some megabytes of a picture for the next one, or not: the least of three looks is what
    // stays. Thirty pictures would be 27 megabytes.
    const auto bytes = [&](std::size_t i) { return reports[i]["host_bytes"].get<double>(); };
    EXPECT_LT(std::min({bytes(3), bytes(4), bytes(5)}), std::min({bytes(0), bytes(1), bytes(2)}) + 12e6);
    EXPECT_LT(bytes(6), bytes(5) + 100e3);
}

TEST(Window, closesWhileAFunctionIsCompiled) {
    RELIEF_DISPLAY;
    const TemporaryFolder folder;
    writeFile(folder / "waves.glsl", "float height(vec3 p, vec2 st, float t) { return 0.1 * sin(9.0 * p.x + t); }\n");
    writeFile(folder / "bad.glsl", "float height(vec3 p, vec2 st, float t) { return waves; }\n");
    const std::string lines =
        "rest\ndrop " + (folder / "bad.glsl") + "\nrest\nreport\ndrop " + (folder / "waves.glsl") + "\nclose\n";
    const std::vector<nlohmann::json> reports = reportsOf(
        relief({"view", cagePath("torus"), "--size", "96,64", "--play", writeSession(folder, "session", lines)}));
    ASSERT_EQ(reports.size(), 1u);
    EXPECT_TRUE(contains(reports[0]["error"], "bad.glsl:1")) << reports[0];
}

TEST(Window, saysWhyItCannotOpen) {
    unsetenv("DISPLAY");
    unsetenv("WAYLAND_DISPLAY");
    expectRefused(relief({"view", cagePath("torus")}), Failure::device, {"display", "relief render"});
    expectRefused(relief({"view", "none.obj"}), Failure::device, {"display"});
    expectRefused(relief({"view", cagePath("torus"), "--quit-after", "0"}), Failure::usage, {"--quit-after"});
    RELIEF_DISPLAY;
    const TemporaryFolder folder;
    expectRefused(relief({"view", "none.obj"}), Failure::file, {"none.obj"});
    expectRefused(relief({"view", cagePath("torus"), "--play", writeSession(folder, "session", "rest\nmouse 1 2\n")}),
                  Failure::input, {"session:2", "mouse"});
    expectRefused(relief({"view", cagePath("torus"), "--record", folder / "no/session"}), Failure::file, {"no"});
}

TEST(Window, endsWithItsDisplay) {
    RELIEF_DISPLAY;
    const TemporaryFolder folder;
    const std::string picture = folder / "a.png";
    const std::string session = writeSession(folder, "session", "rest\nscreenshot " + picture + "\nwait 100\nclose\n");
    const auto endBy = [&](const auto& end) {
        Program window({"view", cagePath("torus"), "--size", "96,64", "--play", session});
        EXPECT_TRUE(waitForFile(picture) && std::filesystem::remove(picture));
        end();
        return window.wait();
    };
    expectRefused(endBy([] { WindowManager::destroyWindows(); }), Failure::device, {"destroyed"});
    expectRefused(endBy([&] { display.stop(); }), Failure::device, {"display"});
}

TEST(Window, recordsWhatItPlays) {
    RELIEF_DISPLAY;
    const TemporaryFolder folder;
    const std::string lines = "rest\nmove 50 20\npress left shift\nmove 60 25\nrelease left\nrest\nkey W\nclose\n";
    expectDone(relief({"view", cagePath("torus"), "--size", "96,64", "--play", writeSession(folder, "session", lines),
                       "--record", folder / "recorded"}));
    // When the picture comes to rest between events is the device's.
    const auto withoutRests = [](const std::string& text) {
        std::string kept;
        std::istringstream each(text);
        for (std::string line; std::getline(each, line);)
            if (line != "rest") kept += line + '\n';
        return kept;
    };
    const std::string recorded = readFile(folder / "recorded");
    EXPECT_EQ(withoutRests(recorded), withoutRests(lines));
    EXPECT_TRUE(recorded.starts_with("rest\nmove 50 20\n")) << recorded;
}

TEST(Window, writesItsFirstPictureAndCloses) {
    RELIEF_DISPLAY;
    const TemporaryFolder folder;
    const Outcome outcome = relief({"view", cagePath("torus"), "--size", "96,64", "--screenshot", folder / "a.png",
                                    "--quit-after", "3", "--json"});
    EXPECT_EQ(jsonOf(outcome)["frames"], 3);
    expectDone(relief({"render", cagePath("torus"), "--size", "96,64", "-o", folder / "b.png", "--quiet"}));
    EXPECT_TRUE(readFile(folder / "a.png") == readFile(folder / "b.png"));
}

} // namespace
} // namespace relief::test

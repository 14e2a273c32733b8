// What drivers do on no request: a device or a surface that is lost, images of the window that are out of date. A layer
// of the tests makes calls fail (tests/faults).
#include <fmt/format.h>

#include "display.h"

namespace relief::test {
namespace {

/// While it lives, the given call of programs that are started gives that VkResult, at its so-manieth time.
class Fault {
public:
    Fault(const std::string& call, int count, int result) {
        setenv("VK_ADD_LAYER_PATH", RELIEF_BINARY_DIR "/faults", 1);
        setenv("VK_INSTANCE_LAYERS", "VK_LAYER_RELIEF_faults", 1);
        setenv("RELIEF_FAULT", fmt::format("{} {} {}", call, count, result).c_str(), 1);
    }
    ~Fault() {
        for (const char* name : {"VK_ADD_LAYER_PATH", "VK_INSTANCE_LAYERS", "RELIEF_FAULT"}) unsetenv(name);
    }
    Fault(const Fault&) = delete;
    Fault& operator=(const Fault&) = delete;
};

constexpr int kDeviceLost = -4, kSurfaceLost = -1000000000, kOutOfDate = -1000001004;

Words namesIn(const TemporaryFolder& folder) {
    Words names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path))
        names.push_back(entry.path().filename());
    std::ranges::sort(names);
    return names;
}

TEST(Faults, ofALostDeviceEndARenderWithoutAFile) {
    const TemporaryFolder folder;
    for (const auto& [call, count] : {std::pair("vkQueueSubmit2", 2), std::pair("vkWaitForFences", 1)}) {
        const Fault fault(call, count, kDeviceLost);
        expectRefused(relief({"render", cagePath("cube"), "--size", "64,64", "--rate", "3", "-o", folder / "a.png"}),
                      Failure::device, {call, "the device was lost"});
        EXPECT_EQ(namesIn(folder), Words());
    }
}

TEST(Faults, ofALostDeviceLeaveWholeFramesAlone) {
    const TemporaryFolder folder;
    const Words animate = {"animate",  cagePath("cube"),
                           "--deform", "twist(axis=y, angle=30*t)",
                           "--size",   "64,64",
                           "--rate",   "3",
                           "--frames", "0:5",
                           "--quiet",  "--progress=never",
                           "-o"};
    Words frames = animate, clip = animate;
    frames.push_back(folder / "f.{frame}.png"), clip.push_back(folder / "clip.mp4");
    const Fault fault("vkQueueSubmit2", 12, kDeviceLost);
    expectRefused(relief(frames), Failure::device, {"the device was lost"});
    // Frames that were done before are pictures; no other file is there.
    const Words names = namesIn(folder);
    EXPECT_GE(names.size(), 1u);
    EXPECT_LT(names.size(), 6u);
    for (const std::string& name : names) EXPECT_EQ(readImage(folder / name).width, 64) << name;
    expectRefused(relief(clip), Failure::device, {"the device was lost"});
    EXPECT_EQ(namesIn(folder), names);
}

TEST(Faults, ofALostDeviceOrSurfaceEndTheWindow) {
    RELIEF_DISPLAY;
    const TemporaryFolder folder;
    const std::string session =
        writeSession(folder, "session", "rest\nkey W\nrest\nframes 5\nscreenshot " + (folder / "a.png") + "\nclose\n");
    const auto run = [&] {
        return relief({"view", cagePath("cube"), "--size", "96,64", "--rate", "3", "--play", session});
    };
    const std::tuple<const char*, int, int, const char*> faults[] = {
        {"vkQueueSubmit2", 9, kDeviceLost, "the device was lost"},
        {"vkAcquireNextImageKHR", 3, kDeviceLost, "the device was lost"},
        {"vkAcquireNextImageKHR", 2, kSurfaceLost, "the window's surface was lost"},
        {"vkQueuePresentKHR", 3, kSurfaceLost, "the window's surface was lost"}};
    for (const auto& [call, count, result, words] : faults) {
        const Fault fault(call, count, result);
        expectRefused(run(), Failure::device, {call, words});
        EXPECT_EQ(namesIn(folder), Words{"session"}) << call;
    }
}

// The window makes its images anew and goes on.
TEST(Faults, ofImagesThatAreOutOfDateChangeNothing) {
    RELIEF_DISPLAY;
    const TemporaryFolder folder;
    const std::string session = writeSession(folder, "session",
                                             "key Tab\nrest\nkey Escape\nrest\nframes 2\nrest\nscreenshot " +
                                                 (folder / "a.png") + "\nreport\nclose\n");
    expectDone(
        relief({"render", cagePath("cube"), "--size", "96,64", "--rate", "3", "--quiet", "-o", folder / "b.png"}));
    for (const char* call : {"vkAcquireNextImageKHR", "vkQueuePresentKHR"}) {
        const Fault fault(call, 2, kOutOfDate);
        const std::vector<nlohmann::json> reports =
            reportsOf(relief({"view", cagePath("cube"), "--size", "96,64", "--rate", "3", "--play", session}));
        ASSERT_EQ(reports.size(), 1u);
        EXPECT_GE(reports[0]["pictures"], 2) << call; // drawn again for the new images
        EXPECT_TRUE(readFile(folder / "a.png") == readFile(folder / "b.png")) << call;
    }
}

} // namespace
} // namespace relief::test

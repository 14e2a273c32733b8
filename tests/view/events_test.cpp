// Recorded events read back as they were, and the command line of what is shown.
#include <gtest/gtest.h>

#include "view/events.h"
#include "view/keys.h"
#include "view/view.h"

namespace relief::test {
namespace {

std::string roundTrip(const std::string& line) {
    const auto event = parseEvent(line, "session:1");
    return event ? toLine(*event) : "";
}

TEST(Events, readBackAsTheyWereWritten) {
    for (const char* line :
         {"move 12.5 -3", "point 0.5 field of view", "press left shift", "press middle", "release right", "wheel -1",
          "key F12", "key ?", "text a b", "drop /tmp/a file.obj", "size 640 400", "minimise", "restore", "frame 12",
          "rest", "wait 0.5", "screenshot out/a b.png", "report", "close"})
        EXPECT_EQ(roundTrip(line), line);
    for (const Word<int>& key : kKeys) EXPECT_EQ(parseEvent(std::string("key ") + key.word, "x")->key, key.value);
    EXPECT_EQ(roundTrip("# a comment"), "");
    EXPECT_EQ(roundTrip("  "), "");
}

TEST(Events, areRefusedWithTheirLine) {
    for (const char* line : {"mouse 1 2", "point 0.5", "move 1", "move 1 nan", "press", "press top", "press left alt",
                             "key F99", "drop", "wheel up"}) {
        try {
            parseEvent(line, "session.txt:7");
            ADD_FAILURE() << line << " is taken";
        } catch (const Error& error) {
            EXPECT_EQ(error.failure, Failure::input);
            EXPECT_TRUE(std::string(error.what()).starts_with("session.txt:7: ")) << error.what();
        }
    }
}

TEST(Command, isTheGivenOneWithWhatHasChanged) {
    Look first;
    first.scene.object.cage = "a cage.obj";
    first.scene.object.height.path = "h.exr";
    const std::vector<GivenOption> given = {
        {"", "a cage.obj"}, {"--height", "h.exr"}, {"--azimuth", "10"}, {"--no-shadows", ""}, {"--edge-pixels", "3"}};
    first.scene.camera.azimuth = 10;
    first.scene.lighting.castsShadows = false;
    first.triangles.edgePixels = 3;
    Look look = first;
    look.scene.size = {640, 400};
    using Words = std::vector<std::string>;
    const Words start{"relief", "render", "a cage.obj", "--height=h.exr"};
    Words same = start;
    for (const char* word : {"--azimuth=10", "--no-shadows", "--edge-pixels=3", "--size=640,400"})
        same.emplace_back(word);
    EXPECT_EQ(toCommandWords("render", given, first, look), same);

    // Changed options stand where they stood, new ones behind, and what excludes another removes it.
    look.scene.camera.azimuth = -0.125;
    look.scene.lighting.castsShadows = true;
    look.triangles.rate = 8;
    look.scene.camera.lookAt = dvec3(-1, 0, 0.1);
    Words changed = start;
    for (const char* word : {"--azimuth=-0.125", "--rate=8", "--size=640,400", "--look-at=-1,0,0.1"})
        changed.emplace_back(word);
    EXPECT_EQ(toCommandWords("render", given, first, look), changed);
    look.frame = 7;
    changed[1] = "animate";
    changed.emplace_back("--frames=7:7");
    EXPECT_EQ(toCommandWords("animate", given, first, look), changed);
}

TEST(Command, isQuotedForAShell) {
    EXPECT_EQ(toShellLine({"relief", "it's.obj", "--a=1,2", ""}), "relief 'it'\\''s.obj' --a=1,2 ''");
}

} // namespace
} // namespace relief::test

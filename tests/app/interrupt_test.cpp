// Ctrl-C: exit code 130, and no file that was not there before.
#include "program.h"

namespace relief::test {
namespace {

using namespace std::chrono_literals;

/// Waits until the program has said `word`, at most half a minute.
bool waitFor(const Program& program, const std::string& word) {
    for (int i = 0; i < 3000; ++i) {
        if (contains(program.errorsSoFar(), word)) return true;
        std::this_thread::sleep_for(10ms);
    }
    return false;
}

TEST(Interrupts, duringARenderLeaveTheOldPicture) {
    const TemporaryFolder folder;
    putFile(folder / "a.exr", "old");
    // Large enough that it cannot end between the first step and the signal.
    Program program(
        {"render", cagePath("cube"), "--size", "4096,4096", "--progress", "always", "-o", folder / "a.exr"});
    ASSERT_TRUE(waitFor(program, "rendering"));
    program.signal(SIGINT);
    const Outcome outcome = program.wait();
    EXPECT_EQ(outcome.exitCode, 130) << outcome.err;
    EXPECT_TRUE(outcome.err.ends_with("relief: interrupted\n")) << outcome.err;
    EXPECT_EQ(readFile(folder / "a.exr"), "old");
    EXPECT_EQ(folder.fileCount(), 1u);
}

/// Begins to write, then gets the signal.
[[noreturn]] void writeInterrupted(const std::string& path, int signal) {
    endCleanlyOnInterrupt();
    writeWhole(path, [&](const std::string& temporary) {
        putFile(temporary, "half of the n");
        kill(getpid(), signal);
        std::this_thread::sleep_for(30s);
    });
    _exit(0);
}

/// An empty folder that a death test's second process, which runs the test anew, finds under the same name.
std::string emptyFolder(const std::string& name) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    const std::string folder = fmt::format("{}/{}", RELIEF_BINARY_DIR, name);
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    return folder;
}

TEST(InterruptsDeathTest, whileWritingRemoveTheTemporaryFile) {
    ::signal(SIGINT, SIG_DFL); // a script's background job starts with SIGINT ignored
    const std::string folder = emptyFolder("interrupted");
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        EXPECT_EXIT(writeInterrupted(folder + "/a.txt", signal), ::testing::ExitedWithCode(128 + signal),
                    "interrupted");
        EXPECT_TRUE(std::filesystem::is_empty(folder));
    }
}

[[noreturn]] void ignoreInterrupt(const std::string& path) {
    ::signal(SIGINT, SIG_IGN);
    endCleanlyOnInterrupt();
    kill(getpid(), SIGINT);
    std::this_thread::sleep_for(100ms);
    writeFile(path, "whole");
    _exit(0);
}

TEST(InterruptsDeathTest, areIgnoredWhereTheyWereIgnoredBefore) {
    const std::string folder = emptyFolder("not-interrupted");
    EXPECT_EXIT(ignoreInterrupt(folder + "/a.txt"), ::testing::ExitedWithCode(0), "");
    EXPECT_EQ(readFile(folder + "/a.txt"), "whole");
}

} // namespace
} // namespace relief::test

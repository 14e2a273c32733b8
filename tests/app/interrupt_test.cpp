// Ctrl-C: exit code 130, and no file that was not there before.
#include <array>
#include <fstream>

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

/// Whether a process has this in its command line.
bool isRunning(const std::string& part) {
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
        std::ifstream file(entry.path() / "cmdline");
        std::string words;
        std::getline(file, words, '\0'); // the program
        for (std::string word; std::getline(file, word, '\0');) words += " " + word;
        if (contains(words, part)) return true;
    }
    return false;
}

// Ctrl-C and its like, and even an end without any chance to clean up.
TEST(Interrupts, ofAClipLeaveNoFileAndNoProcess) {
    if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) GTEST_SKIP() << "ffmpeg is not installed";
    const TemporaryFolder folder;
    const std::vector<std::string> clips{"a.gif", "a.mp4", "a.webm"};
    for (int round = 0; round < 8; ++round) {
        const int signal = std::array{SIGINT, SIGTERM, SIGHUP, SIGKILL}[std::size_t(round % 4)];
        SCOPED_TRACE(fmt::format("round {}, signal {}", round, signal));
        Program program({"animate", cagePath("cube"), "--turntable", "2000", "--size", "32,32", "--rate", "1",
                         "--progress", "always", "-o", folder / clips[std::size_t(round) % clips.size()]});
        ASSERT_TRUE(waitFor(program, "animating"));
        std::this_thread::sleep_for(round / 4 * 100ms); // before ffmpeg has opened the file, and later
        program.signal(signal);
        EXPECT_EQ(program.wait().exitCode, 128 + signal);
        EXPECT_EQ(folder.fileCount(), 0u);
        const std::string itsFiles = fmt::format("file:/proc/{}/", program.id());
        for (int i = 0; i < 500 && isRunning(itsFiles); ++i) std::this_thread::sleep_for(10ms);
        EXPECT_FALSE(isRunning(itsFiles));
        EXPECT_EQ(folder.fileCount(), 0u);
    }
}

// An encoder that does not look at its input would go on for minutes.
TEST(Interrupts, endTheEncoderWhateverItDoes) {
    const TemporaryFolder folder;
    putFile(folder / "ffmpeg", "#!/bin/sh\ncase \"$*\" in *-version) exit 0;; esac\nexec sleep \"$RELIEF_SLEEP\"\n");
    std::filesystem::permissions(folder / "ffmpeg", std::filesystem::perms(0755));
    const std::string path = std::getenv("PATH"), seconds = fmt::format("300.{}", getpid());
    setenv("RELIEF_SLEEP", seconds.c_str(), 1);
    setenv("PATH", (folder.path.string() + ":" + path).c_str(), 1);
    for (const int signal : {SIGINT, SIGKILL}) {
        Program program({"animate", cagePath("cube"), "--turntable", "2000", "--size", "32,32", "--rate", "1",
                         "--progress", "always", "-o", folder / "a.gif"});
        EXPECT_TRUE(waitFor(program, "animating"));
        for (int i = 0; i < 500 && !isRunning("sleep " + seconds); ++i) std::this_thread::sleep_for(10ms);
        EXPECT_TRUE(isRunning("sleep " + seconds));
        program.signal(signal);
        EXPECT_EQ(program.wait().exitCode, 128 + signal);
        for (int i = 0; i < 500 && isRunning("sleep " + seconds); ++i) std::this_thread::sleep_for(10ms);
        EXPECT_FALSE(isRunning("sleep " + seconds)) << "after signal " << signal;
    }
    setenv("PATH", path.c_str(), 1);
    EXPECT_EQ(folder.fileCount(), 1u);
}

TEST(Interrupts, ofABenchLeaveNoFolderAndNoProcess) {
    const TemporaryFolder folder;
    Program program(
        {"-c", fmt::format("TMPDIR={} exec {} bench startup --quick", folder.path.string(), RELIEF_PROGRAM)},
        "/bin/sh");
    const std::string itsFiles = folder / "relief-bench-";
    for (int i = 0; i < 6000 && !isRunning(itsFiles); ++i) std::this_thread::sleep_for(10ms);
    EXPECT_TRUE(isRunning(itsFiles));
    program.signal(SIGINT);
    EXPECT_EQ(program.wait().exitCode, 130);
    EXPECT_EQ(folder.fileCount(), 0u);
    for (int i = 0; i < 500 && isRunning(itsFiles); ++i) std::this_thread::sleep_for(10ms);
    EXPECT_FALSE(isRunning(itsFiles));
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

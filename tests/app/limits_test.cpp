// Hard conditions: links, disks that are full, inputs that would be overwritten, memory and threads that run out.
#include "program.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;

#ifdef __SANITIZE_ADDRESS__
constexpr bool kLimitsMemory = false; ///< the sanitizer's own takes terabytes of addresses
#else
constexpr bool kLimitsMemory = true;
#endif

const Words kQuick{"render", cagePath("cube"), "-q", "--size", "16,16", "--rate", "1"};

Words renderTo(const std::string& target) {
    Words words = kQuick;
    words.insert(words.end(), {"-o", target});
    return words;
}

// --- where results go ----------------------------------------------------------------------------------------------

TEST(Outputs, goWhereALinkPoints) {
    const TemporaryFolder folder;
    fs::create_directory(folder / "real");
    fs::create_symlink("real/picture.png", folder / "a.png");
    for (int round = 0; round < 2; ++round) { // makes it, then replaces it
        expectDone(relief(renderTo(folder / "a.png")));
        EXPECT_TRUE(fs::is_symlink(folder / "a.png"));
        EXPECT_EQ(readImageInfo(folder / "real/picture.png").width, 16);
    }
}

TEST(Outputs, areRefusedBehindLinksThatLeadNowhere) {
    const TemporaryFolder folder;
    fs::create_symlink("b.png", folder / "a.png");
    fs::create_symlink("a.png", folder / "b.png");
    fs::create_symlink("none/c.png", folder / "c.png");
    expectRefused(relief(renderTo(folder / "a.png")), Failure::file, {"a.png", "symbolic links"});
    expectRefused(relief(renderTo(folder / "c.png")), Failure::file, {"none/c.png"});
    EXPECT_EQ(folder.fileCount(), 3u);
}

TEST(Outputs, thatAreInputsAreRefusedBeforeTheyAreLost) {
    const TemporaryFolder folder;
    fs::copy_file(cagePath("cube"), folder / "cube.obj");
    fs::copy_file(cagePath("cube"), folder / "cube.1.obj");
    fs::create_symlink("cube.obj", folder / "link.obj");
    writeImage(folder / "h.exr", sineImage(16, 1), SampleType::real);
    writeImage(folder / "h.2.png", sineImage(16, 1), SampleType::uint8);
    putFile(folder / "points.csv", "0,0.5,0.5\n");
    const std::string cube = folder / "cube.obj", map = folder / "h.exr", points = folder / "points.csv";
    for (const Words& words :
         {Words{"export", cube, "-o", cube}, Words{"export", cube, "-o", folder / "link.obj"},
          Words{"export", cube, "--cache", folder / "cube.{frame}.obj", "-o", folder / "cube.1.obj"},
          Words{"render", cube, "--height", map, "-o", map}, Words{"render", cube, "--albedo", map, "-o", map},
          Words{"sample", cube, "--at", points, "-o", points}, Words{"check", cube, "--height", map, "--heatmap", map},
          Words{"animate", "-q", cube, "--height", folder / "h.2.png", "--turntable", "2", "-o",
                folder / "h.{frame}.png"},
          Words{"bench", "--from", cube, "--csv", cube}}) {
        SCOPED_TRACE(fmt::format("{}", fmt::join(words, " ")));
        expectRefused(relief(words), Failure::usage, {"input"});
    }
    EXPECT_EQ(readFile(cube), readFile(cagePath("cube")));
    EXPECT_EQ(folder.fileCount(), 6u);
}

TEST(Outputs, inADeletedFolderAreRefused) {
    const TemporaryFolder folder;
    const std::string there = "mkdir $IN/gone && cd $IN/gone && rmdir $IN/gone && $RELIEF ";
    for (const std::string& words :
         {"render " + cagePath("cube") + " -o a.png", std::string("render a.obj -o a.png"),
          "animate " + cagePath("cube") + " --turntable 2 -o f.{frame}.png",
          "animate " + cagePath("cube") + " --turntable 2 -o a.gif", "export " + cagePath("cube") + " -o a.ply",
          std::string("info a.obj"), std::string("info a.gltf"), std::string("bench --from a.json")}) {
        SCOPED_TRACE(words);
        expectRefused(shell(there + words, folder), Failure::file, {"No such file"});
    }
}

TEST(Outputs, onStdoutThatIsFullOrClosedExitWith4) {
    const TemporaryFolder folder;
    for (const char* where : {">/dev/full", ">&-"}) {
        expectRefused(shell("$RELIEF info " + cagePath("cube") + " " + where, folder), Failure::file, {"stdout"});
        expectRefused(shell("$RELIEF info --json " + cagePath("cube") + " " + where, folder), Failure::file,
                      {"stdout"});
    }
}

TEST(Outputs, doNotNeedStderr) {
    const TemporaryFolder folder;
    putFile(folder / "odd.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\nwhat 1\n"); // with a warning
    for (const char* where : {"2>/dev/full", "2>&-", "2>&- >&- <&-"}) {
        const Outcome outcome = shell(
            fmt::format("$RELIEF render $IN/odd.obj --size 16,16 --progress always -o $IN/a.png {}", where), folder);
        EXPECT_EQ(outcome.exitCode, 0) << where;
        EXPECT_EQ(readImageInfo(folder / "a.png").width, 16) << where; // and nothing that was printed is in it
        fs::remove(folder / "a.png");
    }
}

// What is opened later must not get the number of what is closed, or it gets what is printed.
TEST(Outputs, neverTakeThePlaceOfStdoutOrStderr) {
    const TemporaryFolder folder;
    Program program({"-c", fmt::format("exec {} animate {} --turntable 2000 --size 16,16 --rate 1 -o "
                                       "{}/f.{{frame}}.png <&- >&- 2>&-",
                                       RELIEF_PROGRAM, cagePath("cube"), folder.path.string())},
                    "/bin/sh");
    for (int i = 0; i < 3000 && folder.fileCount() == 0; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    for (int file = 0; file < 3; ++file)
        EXPECT_EQ(fs::read_symlink(fmt::format("/proc/{}/fd/{}", program.id(), file)), "/dev/null") << file;
    program.signal(SIGTERM);
    EXPECT_EQ(program.wait().exitCode, 128 + SIGTERM);
}

// --- disks that are full -------------------------------------------------------------------------------------------

TEST(FullDisks, endEachVerbWith4AndLeaveNothing) {
    const TemporaryFolder folder;
    std::string points;
    for (int i = 0; i < 60; ++i) points += "0,0.5,0.5\n";
    putFile(folder / "points.csv", points);
    const std::string cube = cagePath("cube");
    for (const std::string& words :
         {"render " + cube + " --size 64,64 -o $IN/a.png", "render " + cube + " --size 64,64 -o $IN/a.exr",
          "export " + cube + " --rate 8 -o $IN/a.ply", "export " + cube + " --rate 8 -o $IN/a.obj",
          "export " + cube + " --rate 8 -o $IN/a.glb", "sample " + cube + " --at $IN/points.csv -o $IN/a.csv",
          "animate " + cube + " --deform 'twist(axis=y,angle=9*t)' --frames 1:9 -o $IN/a.pc2",
          "animate " + cube + " --turntable 2 --size 64,64 -o $IN/f.{frame}.png"}) {
        SCOPED_TRACE(words);
        expectRefused(shell("ulimit -f 1; export MESA_SHADER_CACHE_DISABLE=1; $RELIEF " + words, folder), Failure::file,
                      {folder.path.string(), "File too large"});
        EXPECT_EQ(folder.fileCount(), 1u);
    }
}

TEST(FullDisks, endClipsWith4AndLeaveNothing) {
    if (std::system("ffmpeg -version >/dev/null 2>&1") != 0) GTEST_SKIP() << "ffmpeg is not installed";
    const TemporaryFolder folder;
    for (const char* extension : {"gif", "mp4", "webm", "webp"}) {
        SCOPED_TRACE(extension);
        const std::string words = fmt::format(" --turntable 12 --size 128,128 -o $IN/a.{}", extension);
        expectRefused(
            shell("ulimit -f 1; export MESA_SHADER_CACHE_DISABLE=1; $RELIEF animate " + cagePath("cube") + words,
                  folder),
            Failure::file, {folder / fmt::format("a.{}", extension), "ffmpeg"});
        EXPECT_EQ(folder.fileCount(), 0u);
    }
}

// --- memory and threads that run out -------------------------------------------------------------------------------

TEST(Memory, thatCannotBeAllocatedExitsWith5AndNamesTheSize) {
    if (!kLimitsMemory) GTEST_SKIP() << "the sanitizer has its own memory";
    const TemporaryFolder folder;
    putFile(folder / "large.json", "");
    fs::resize_file(folder / "large.json", 3'000'000'000); // without a single block
    expectRefused(shell("ulimit -v 2000000; $RELIEF bench --from $IN/large.json", folder), Failure::device,
                  {"out of memory", "3.0 GB"});
}

// Wherever it runs out: in the loader of the driver, in its compiler, in its memory.
TEST(Memory, thatRunsOutInALibraryExitsWith5) {
    if (!kLimitsMemory) GTEST_SKIP() << "the sanitizer has its own memory";
    const TemporaryFolder folder;
    bool isRefused = false;
    for (const int megabytes : {650, 750, 800, 850, 900, 950, 1050}) {
        SCOPED_TRACE(megabytes);
        const Outcome outcome = shell(
            fmt::format("export MESA_SHADER_CACHE_DISABLE=1; ulimit -c 0; ulimit -v {}000; $RELIEF render {} -q --size "
                        "64,64 -o $IN/a.png",
                        megabytes, cagePath("cube")),
            folder);
        EXPECT_TRUE(outcome.exitCode == 0 || outcome.exitCode == int(Failure::device))
            << outcome.exitCode << outcome.err;
        EXPECT_EQ(fs::remove(folder / "a.png"), outcome.exitCode == 0);
        EXPECT_EQ(contains(outcome.err, "memory"), outcome.exitCode != 0) << outcome.err;
        isRefused = isRefused || outcome.exitCode != 0;
    }
    EXPECT_TRUE(isRefused);
}

TEST(Threads, thatCannotBeStartedExitWith5) {
    if (!kLimitsMemory) GTEST_SKIP() << "the sanitizer's own start before they could be counted";
    const TemporaryFolder folder;
    // The limit is for all processes of a user, and not for root.
    const std::string other = getuid() == 0 ? "setpriv --reuid 65534 --clear-groups -- " : "";
    const Outcome few = shell(other + "prlimit --nproc=3 $RELIEF --version", folder);
    if (few.exitCode == 126 || few.exitCode == 127) GTEST_SKIP() << "the program cannot be run by another user";
    expectRefused(few, Failure::device, {"threads", "ulimit -u"});
    EXPECT_EQ(shell(other + "$RELIEF --version", folder).exitCode, 0);
}

} // namespace
} // namespace relief::test

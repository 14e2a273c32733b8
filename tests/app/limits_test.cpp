// Hard conditions: links, disks that are full, inputs that would be overwritten, memory and threads that run out.
#include <sys/mount.h>
#include <sys/resource.h>

#include "program.h"

namespace relief::test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

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
          Words{"animate", cube, "--height", folder / "h.2.png", "--turntable", "2", "-o", folder / "h.{frame}.png"},
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

// --- disks that are full -------------------------------------------------------------------------------------------

TEST(FullDisks, endEachVerbWith4AndLeaveNothing) {
    const TemporaryFolder folder;
    putFile(folder / "points.csv", std::string(200, '\n') + "0,0.5,0.5\n1,0.5,0.5\n2,0.5,0.5\n3,0.5,0.5\n4,0.5,0.5\n");
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

} // namespace
} // namespace relief::test

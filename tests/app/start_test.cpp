// What the program loads: OpenImageIO and its 260 libraries come with the first picture that needs them, not with the
// program.
#include "program.h"

namespace relief::test {
namespace {

/// Runs the program, and returns how often OpenImageIO was loaded.
int countImageLibraries(const std::string& words) {
    const TemporaryFolder folder;
    writeImage(folder / "map.exr", {2, 2, 1, {0, 0, 0, 1}}, SampleType::half);
    const Outcome outcome = shell("LD_DEBUG=files LD_DEBUG_OUTPUT=$IN/loaded $RELIEF " + words +
                                      " > /dev/null && cat $IN/loaded.* > $IN/all",
                                  folder);
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    const std::string loaded = readFile(folder / "all");
    EXPECT_TRUE(contains(loaded, "libvulkan")) << "nothing was listed";
    int count = 0;
    for (std::size_t at = 0; (at = loaded.find("calling init: ", at)) != loaded.npos; ++at)
        count += loaded.substr(at, loaded.find('\n', at) - at).find("libOpenImageIO.so") != std::string::npos;
    return count;
}

TEST(Start, loadsNoImageLibraryWithoutAPicture) {
    EXPECT_EQ(countImageLibraries("--help"), 0);
    EXPECT_EQ(countImageLibraries("info " + cagePath("torus")), 0);
    EXPECT_EQ(countImageLibraries("render --size 32,32 -o $IN/a.png " + cagePath("cube")), 0);
}

TEST(Start, loadsTheImageLibraryWithAPicture) { EXPECT_EQ(countImageLibraries("info $IN/map.exr"), 1); }

} // namespace
} // namespace relief::test

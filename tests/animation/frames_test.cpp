#include <climits>

#include "animation/caches.h"

namespace relief::test {
namespace {

TEST(FrameName, putsTheNumberInItsPlace) {
    EXPECT_EQ(frameName("a.{frame}.png", 7), "a.7.png");
    EXPECT_EQ(frameName("a.{frame:4}.png", 7), "a.0007.png");
    EXPECT_EQ(frameName("a.{frame:4}.png", 12345), "a.12345.png");
    EXPECT_EQ(frameName("{frame:1}", 0), "0");
    EXPECT_EQ(frameName("d/{frame:9}", 1), "d/000000001");
    EXPECT_EQ(frameName("{frame}/a.png", 3), "3/a.png");
}

TEST(FrameName, putsTheMinusBeforeTheDigits) {
    EXPECT_EQ(frameName("{frame}", -7), "-7");
    EXPECT_EQ(frameName("{frame:4}", -7), "-0007");
    EXPECT_EQ(frameName("{frame}", INT_MIN), "-2147483648");
    EXPECT_EQ(frameName("{frame}", INT_MAX), "2147483647");
}

TEST(FrameName, leavesOtherBracesAlone) {
    EXPECT_EQ(frameName("{shot}.{frame}{}", 7), "{shot}.7{}");
    EXPECT_EQ(frameName("a}{frame}{", 7), "a}7{");
}

TEST(FrameName, refusesPatternsWithoutExactlyOnePlaceholder) {
    for (const std::string pattern : {"", "a.png", "{}", "{0}", "a.{shot}.png", "%04d", "frame"})
        expectFailure(Failure::usage, {pattern, "{frame:4}"}, [&] { frameName(pattern, 1); });
    expectFailure(Failure::usage, {"2 places"}, [] { frameName("{frame}.{frame:4}", 1); });
}

TEST(FrameName, refusesPlaceholdersThatAreMisspelt) {
    for (const std::string place : {"{frame:0}", "{frame:10}", "{frame:04}", "{frame:}", "{frame:x}", "{frame:-1}",
                                    "{frames}", "{Frame}", "{fram}", "{frame 4}", "{frame:4", "{frame", "{frame:{4}"})
        if (isFramePattern(place))
            expectFailure(Failure::usage, {"'" + place + "'", "{frame:DIGITS}", "1 to 9"},
                          [&] { frameName(place, 1); });
        else
            ADD_FAILURE() << place << " is meant to be a placeholder";
}

TEST(IsFramePattern, separatesPatternsFromNames) {
    EXPECT_TRUE(isFramePattern("a.{frame}.obj"));
    EXPECT_TRUE(isFramePattern("{a}{frame:4}"));
    for (const std::string name : {"", "a.obj", "frame.obj", "{shot}.obj", "{}", "{", "}", "{:4}"})
        EXPECT_FALSE(isFramePattern(name)) << name;
}

// --- sequences of cages --------------------------------------------------------------------------------------------

void putFrames(const TemporaryFolder& folder, const std::string& pattern, const Cage& cage,
               const std::vector<int>& frames) {
    for (const int frame : frames) {
        Cage moved = cage;
        moved.positions = movedPoints(cage, frame);
        writeObj(folder / frameName(pattern, frame), moved);
    }
}

TEST(CageSequence, readsBackTheBitsOfEveryFrame) {
    const TemporaryFolder folder;
    putFrames(folder, "a.{frame:4}.obj", cube(), {-1, 0, 1, 9999, 10000});
    const auto animation = readQuietly(folder / "a.{frame:4}.obj", cube(), {.fps = 30});
    for (const int frame : {-1, 0, 1, 9999, 10000})
        EXPECT_TRUE(haveSameBits(animation->pose(frame / 30.0).positions, movedPoints(cube(), frame))) << frame;
    EXPECT_EQ(animation->keyRange(), dvec2(-1 / 30.0, 10000 / 30.0));
}

TEST(CageSequence, sortsFramesByTheirNumbers) {
    const TemporaryFolder folder;
    putFrames(folder, "{frame}.obj", cube(), {10, 9, 100, 8});
    const auto animation = readQuietly(folder / "{frame}.obj", cube());
    EXPECT_EQ(animation->keyRange(), dvec2(8 / 24.0, 100 / 24.0));
    expectNear(animation->pose(8.5 / 24).positions, movedPoints(cube(), 8.5), 1e-5);
}

TEST(CageSequence, blendsOverGaps) {
    const TemporaryFolder folder;
    putFrames(folder, "a.{frame}.obj", cube(), {2, 6});
    const auto linear = readQuietly(folder / "a.{frame}.obj", cube());
    const auto step = readQuietly(folder / "a.{frame}.obj", cube(), {.interpolation = Interpolation::step});
    expectNear(linear->pose(3.0 / 24).positions, movedPoints(cube(), 3), 1e-5);
    EXPECT_TRUE(haveSameBits(step->pose(5.0 / 24).positions, movedPoints(cube(), 2)));
}

TEST(CageSequence, skipsFilesOfOtherPatterns) {
    const TemporaryFolder folder;
    putFrames(folder, "a.{frame:4}.obj", cube(), {3, 4});
    for (const std::string name : {"a.5.obj", "a.00006.obj", "a.0007.obj.bak", "b.0008.obj", "a.-009.obj", "a..obj",
                                   "a.99999999999.obj", "a.+010.obj", "a.obj"})
        putFile(folder / name, "not a cage");
    std::filesystem::create_directory(folder / "a.0011.obj");
    const auto animation = readQuietly(folder / "a.{frame:4}.obj", cube());
    EXPECT_EQ(animation->keyRange(), dvec2(3 / 24.0, 4 / 24.0));
}

TEST(CageSequence, namesFrameAndFileWhereTheTopologyChanges) {
    const TemporaryFolder folder;
    const std::string pattern = folder / "a.{frame:4}.obj";
    putFrames(folder, "a.{frame:4}.obj", cube(), {1, 2, 4});
    Cage morePoints = cube(), fewerFaces = cube(), otherSize = cube(), otherCorner = cube();
    morePoints.positions.emplace_back(0);
    fewerFaces.faceSizes.pop_back(), fewerFaces.corners.resize(20);
    otherSize.faceSizes[4] = 3, otherSize.corners.erase(otherSize.corners.begin() + 16);
    std::swap(otherCorner.corners[8], otherCorner.corners[9]);
    const std::vector<std::pair<Cage, std::vector<std::string>>> changes = {
        {morePoints, {"9 points", "the cage has 8"}},
        {fewerFaces, {"5 faces", "the cage has 6"}},
        {otherSize, {"face 4", "3 corners", "in the cage 4"}},
        {otherCorner, {"corner 0 of face 2", "point 1", "in the cage 0"}}};
    for (auto [cage, words] : changes) {
        writeObj(folder / "a.0003.obj", cage);
        const auto animation = readQuietly(pattern, cube());
        words.insert(words.end(), {folder / "a.0003.obj", "frame 3"});
        EXPECT_TRUE(haveSameBits(animation->pose(2 / 24.0).positions, movedPoints(cube(), 2)));
        for (const double frame : {2.5, 3.0, 3.5})
            expectFailure(Failure::input, words, [&] { (void)animation->pose(frame / 24); });
        EXPECT_TRUE(haveSameBits(animation->pose(4 / 24.0).positions, movedPoints(cube(), 4)));
    }
}

TEST(CageSequence, refusesAnotherCageAtOnce) {
    const TemporaryFolder folder;
    putFrames(folder, "a.{frame}.obj", cube(), {1, 2});
    expectFailure(Failure::input, {folder / "a.1.obj", "frame 1", "8 points"},
                  [&] { readQuietly(folder / "a.{frame}.obj", icosahedron()); });
}

TEST(CageSequence, namesFileAndLineOfBadCages) {
    const TemporaryFolder folder;
    putFrames(folder, "a.{frame}.obj", cube(), {1});
    putFile(folder / "a.2.obj", "v 0 0 nan\n");
    const auto animation = readQuietly(folder / "a.{frame}.obj", cube());
    expectFailure(Failure::input, {folder / "a.2.obj:1:", "nan"}, [&] { (void)animation->pose(2 / 24.0); });
    std::filesystem::remove(folder / "a.2.obj");
    expectFailure(Failure::file, {folder / "a.2.obj"}, [&] { (void)animation->pose(2 / 24.0); });
}

TEST(CageSequence, namesPatternsWithoutFiles) {
    const TemporaryFolder folder;
    putFile(folder / "a.1.obj", "");
    expectFailure(Failure::file, {folder / "b.{frame}.obj", "no such file"},
                  [&] { readQuietly(folder / "b.{frame}.obj", cube()); });
    expectFailure(Failure::file, {folder / "none/b.{frame}.obj", "folder"},
                  [&] { readQuietly(folder / "none/b.{frame}.obj", cube()); });
    expectFailure(Failure::usage, {"not in its folder's"}, [&] { readQuietly(folder / "{frame}/a.obj", cube()); });
    expectFailure(Failure::usage, {"'{frame:x}'"}, [&] { readQuietly(folder / "a.{frame:x}.obj", cube()); });
    expectFailure(Failure::input, {"'.ply'", "use .obj"}, [&] { readQuietly(folder / "a.{frame}.ply", cube()); });
}

} // namespace
} // namespace relief::test

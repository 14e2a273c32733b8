// .pc2 and .mdd: what is written reads back, and poses between the frames.
#include "animation/caches.h"

#include <cmath>
#include <fstream>
#include <limits>

namespace relief::test {
namespace {

const std::vector<std::string> kKinds = {".pc2", ".mdd"};

CacheOptions stepping() { return {.interpolation = Interpolation::step}; }

TEST(PointCache, readsBackTheBitsOfEveryFrame) {
    const TemporaryFolder folder;
    const Cage cage = cube();
    for (const std::string& kind : kKinds)
        for (const Interpolation interpolation : {Interpolation::linear, Interpolation::step})
            for (const double fps : {24.0, 30.0, 29.97, 1000.0}) {
                writeFrames(folder / ("a" + kind), cage, 40, 101, fps);
                const auto animation =
                    readQuietly(folder / ("a" + kind), cage, {.fps = fps, .interpolation = interpolation});
                for (int frame = 101; frame < 141; ++frame)
                    EXPECT_TRUE(haveSameBits(animation->pose(frame / fps).positions, movedPoints(cage, frame)))
                        << kind << " at " << fps << ", frame " << frame;
                EXPECT_EQ(animation->rig(), nullptr);
            }
}

TEST(PointCache, keepsEveryFiniteFloat) {
    const TemporaryFolder folder;
    Cage cage = cube();
    using Limits = std::numeric_limits<float>;
    cage.positions[0] = {-0.0f, Limits::denorm_min(), -Limits::denorm_min()};
    cage.positions[1] = {Limits::max(), Limits::lowest(), Limits::min()};
    cage.positions[2] = {0.1f, -1e-30f, 16777217};
    for (const std::string& kind : kKinds) {
        writePointCache(folder / ("a" + kind), {8, 2}, [&](std::uint32_t) { return cage.positions; });
        const auto animation = readQuietly(folder / ("a" + kind), cage);
        EXPECT_TRUE(haveSameBits(animation->pose(0).positions, cage.positions)) << kind;
        EXPECT_TRUE(haveSameBits(animation->pose(1).positions, cage.positions)) << kind;
    }
}

TEST(PointCache, hasTheBytesOfItsFormat) {
    const TemporaryFolder folder;
    const auto points = [](std::uint32_t k) { return std::vector<vec3>{{float(k), 2, 3}}; };
    writePointCache(folder / "a.pc2", {.pointCount = 1, .frameCount = 2, .startFrame = -3}, points);
    std::string expected("POINTCACHE2\0", 12);
    const auto little = [](auto value) { return word(value, std::endian::little); };
    expected += little(1u) + little(1u) + little(-3.0f) + little(1.0f) + little(2u);
    expected += little(0.0f) + little(2.0f) + little(3.0f) + little(1.0f) + little(2.0f) + little(3.0f);
    EXPECT_EQ(readFile(folder / "a.pc2"), expected);

    writePointCache(folder / "a.mdd", {.pointCount = 1, .frameCount = 2, .startFrame = 5, .fps = 20}, points);
    const auto big = [](auto value) { return word(value, std::endian::big); };
    expected = big(2u) + big(1u) + big(0.25f) + big(0.3f);
    expected += big(0.0f) + big(2.0f) + big(3.0f) + big(1.0f) + big(2.0f) + big(3.0f);
    EXPECT_EQ(readFile(folder / "a.mdd"), expected);
}

TEST(PointCache, blendsLinearlyBetweenFrames) {
    const TemporaryFolder folder;
    const Cage cage = cube();
    for (const std::string& kind : kKinds) {
        writeFrames(folder / ("a" + kind), cage, 5);
        const auto animation = readQuietly(folder / ("a" + kind), cage);
        for (const double frame : {0.5, 1.25, 3.9})
            expectNear(animation->pose(frame / 24).positions, movedPoints(cage, frame), 1e-5);
    }
}

TEST(PointCache, keepsTheFrameBeforeWhenItSteps) {
    const TemporaryFolder folder;
    const Cage cage = cube();
    for (const std::string& kind : kKinds) {
        writeFrames(folder / ("a" + kind), cage, 5);
        const auto animation = readQuietly(folder / ("a" + kind), cage, stepping());
        for (const double frame : {1.0, 1.01, 1.5, 1.99})
            EXPECT_TRUE(haveSameBits(animation->pose(frame / 24).positions, movedPoints(cage, 1))) << frame;
    }
}

TEST(PointCache, standsStillBeforeTheFirstFrameAndAfterTheLast) {
    const TemporaryFolder folder;
    const Cage cage = cube();
    const double infinity = std::numeric_limits<double>::infinity();
    for (const std::string& kind : kKinds)
        for (const CacheOptions& options : {CacheOptions{}, stepping()}) {
            writeFrames(folder / ("a" + kind), cage, 5, 24);
            const auto animation = readQuietly(folder / ("a" + kind), cage, options);
            for (const double seconds : {-infinity, -1e300, 0.0, 0.999})
                EXPECT_TRUE(haveSameBits(animation->pose(seconds).positions, movedPoints(cage, 24))) << seconds;
            for (const double seconds : {28.0 / 24, 1.2, 1e300, infinity})
                EXPECT_TRUE(haveSameBits(animation->pose(seconds).positions, movedPoints(cage, 28))) << seconds;
            EXPECT_EQ(animation->keyRange().x, 1);
            EXPECT_NEAR(animation->keyRange().y, 28.0 / 24, 1e-7);
            expectFailure(Failure::usage, {"not a number"}, [&] { (void)animation->pose(std::nan("")); });
        }
}

TEST(PointCache, givesTheSameBitsInAnyOrder) {
    const TemporaryFolder folder;
    const Cage cage = cube();
    writeFrames(folder / "a.pc2", cage, 9);
    const auto forward = readQuietly(folder / "a.pc2", cage);
    std::vector<std::vector<vec3>> poses;
    for (int i = 0; i <= 32; ++i) poses.push_back(forward->pose(i / 96.0).positions);
    const auto other = readQuietly(folder / "a.pc2", cage);
    for (int i = 0; i <= 32; ++i) {
        const int shuffled = i * 7 % 33;
        EXPECT_TRUE(haveSameBits(other->pose(shuffled / 96.0).positions, poses[std::size_t(shuffled)])) << shuffled;
    }
}

TEST(PointCache, countsPc2SamplesInFrames) {
    const TemporaryFolder folder;
    const Cage cage = cube();
    writeFrames(folder / "a.pc2", cage, 3);
    std::string bytes = readFile(folder / "a.pc2");
    bytes.replace(20, 8, word(10.0f, std::endian::little) + word(2.5f, std::endian::little)); // frames 10, 12.5, 15
    putFile(folder / "a.pc2", bytes);
    const auto animation = readQuietly(folder / "a.pc2", cage, {.fps = 10});
    EXPECT_EQ(animation->keyRange(), dvec2(1, 1.5));
    EXPECT_TRUE(haveSameBits(animation->pose(1.25).positions, movedPoints(cage, 1)));
}

TEST(PointCache, takesMddTimesAsSeconds) {
    const TemporaryFolder folder;
    const Cage cage = cube();
    writeFrames(folder / "a.mdd", cage, 3, 0, 10);
    for (const double fps : {1.0, 60.0}) {
        const auto animation = readQuietly(folder / "a.mdd", cage, {.fps = fps});
        EXPECT_TRUE(haveSameBits(animation->pose(0.1).positions, movedPoints(cage, 1)));
    }
}

TEST(PointCache, readsFramesOnlyWhenTheyAreNeeded) {
    const TemporaryFolder folder;
    const Cage cage = cube();
    for (const std::string& kind : kKinds) {
        const std::string path = folder / ("a" + kind);
        writeFrames(path, cage, 9);
        const auto animation = readQuietly(path, cage);
        (void)animation->pose(0), (void)animation->pose(1.5 / 24);
        const std::string before = readFile(path);
        std::fstream(path, std::ios::in | std::ios::out)
            .write(std::string(before.size(), '\xff').data(), before.size());
        // Frames 1 and 2 are kept, the others are read now: all their bits are set.
        EXPECT_TRUE(haveSameBits(animation->pose(1.0 / 24).positions, movedPoints(cage, 1)));
        EXPECT_TRUE(haveSameBits(animation->pose(2.0 / 24).positions, movedPoints(cage, 2)));
        expectFailure(Failure::input, {path, "frame 3", "point 0", "nan"}, [&] { (void)animation->pose(3.0 / 24); });
        std::filesystem::resize_file(path, 40);
        expectFailure(Failure::input, {path, "cut short"}, [&] { (void)animation->pose(4.0 / 24); });
        putFile(path, before);
        EXPECT_TRUE(haveSameBits(animation->pose(4.0 / 24).positions, movedPoints(cage, 4))) << "after a failure";
    }
}

TEST(PointCache, warnsOfASingleFrame) {
    const TemporaryFolder folder;
    const Cage cage = cube();
    for (const std::string& kind : kKinds)
        for (const std::uint32_t frameCount : {1u, 2u}) {
            writeFrames(folder / ("a" + kind), cage, frameCount, 7);
            Warnings warnings;
            const auto animation = readPointCache(folder / ("a" + kind), cage, {}, warnings.warn());
            EXPECT_EQ(warnings.has("only one frame"), frameCount == 1);
            if (frameCount > 1) continue;
            EXPECT_EQ(animation->keyRange(), dvec2(0));
            EXPECT_TRUE(haveSameBits(animation->pose(3).positions, movedPoints(cage, 7)));
        }
}

TEST(PointCache, refusesOtherNamesAndRates) {
    const TemporaryFolder folder;
    const Cage cage = cube();
    for (const std::string name : {"a.abc", "a", "a.obj"}) {
        expectFailure(Failure::input, {name, ".pc2", ".mdd", "cage.{frame:4}.obj"},
                      [&] { readQuietly(folder / name, cage); });
        expectFailure(Failure::usage, {name, ".pc2", ".mdd"}, [&] { writeFrames(folder / name, cage, 1); });
    }
    writeFrames(folder / "a.PC2", cage, 2);
    EXPECT_EQ(readQuietly(folder / "a.PC2", cage)->pose(0).positions.size(), 8u);
    for (const double fps : {0.0, -24.0, 1e-4, 1e7, std::nan("")})
        expectFailure(Failure::usage, {"frames per second", "0.001"},
                      [&] { readQuietly(folder / "a.PC2", cage, {.fps = fps}); });
}

// --- writing -----------------------------------------------------------------------------------------------------

/// Times that are all 0, or otherwise useless, do not matter then.
TEST(PointCache, takesFrameKAsFrameKWhereItIsAsked) {
    const TemporaryFolder folder;
    for (const std::string name : {"a.pc2", "a.mdd"}) {
        const std::string path = folder / name;
        writeFrames(path, cube(), 3, 10);
        std::string bytes = readFile(path);
        if (name == "a.mdd")
            bytes.replace(8, 12, std::string(12, '\0'));
        else
            bytes.replace(20, 8, word(std::nanf(""), std::endian::little) + word(1e-30f, std::endian::little));
        putFile(path, bytes);
        const auto animation = readQuietly(path, cube(), {.fps = 25, .countsFrames = true});
        EXPECT_EQ(animation->keyRange(), dvec2(0, 2 / 25.0)) << name;
        for (int k = 0; k < 3; ++k)
            EXPECT_TRUE(haveSameBits(animation->pose(k / 25.0).positions, movedPoints(cube(), 10 + k))) << name << k;
    }
}

TEST(PointCacheWriting, leavesNothingBehindWhenItFails) {
    const TemporaryFolder folder;
    const Cage cage = cube();
    for (const std::string& kind : kKinds) {
        const std::string path = folder / ("a" + kind);
        const auto write = [&](const std::function<std::vector<vec3>(std::uint32_t)>& positions) {
            writePointCache(path, {8, 5, 100}, positions);
        };
        expectFailure(Failure::input, {path, "frame 103", "7 points", "8 expected"},
                      [&] { write([&](std::uint32_t k) { return std::vector<vec3>(k == 3 ? 7 : 8); }); });
        expectFailure(Failure::input, {path, "frame 104", "point 2", "inf"}, [&] {
            write([&](std::uint32_t k) {
                std::vector<vec3> points(8);
                if (k == 4) points[2].y = std::numeric_limits<float>::infinity();
                return points;
            });
        });
        expectFailure(Failure::device, {"lost"},
                      [&] { write([](std::uint32_t) -> std::vector<vec3> { fail(Failure::device, "device lost"); }); });
        const FullDisk disk(300);
        expectFailure(Failure::file, {path}, [&] { writeFrames(path, cage, 50); });
    }
    EXPECT_EQ(folder.fileCount(), 0u);
    expectFailure(Failure::file, {"none/a.pc2"}, [&] { writeFrames(folder / "none/a.pc2", cage, 1); });
}

TEST(PointCacheWriting, refusesHeadersThatTheFormatCannotHold) {
    const TemporaryFolder folder;
    const auto refuse = [&](const std::string& name, const CacheHeader& header, std::vector<std::string> words) {
        words.push_back(name);
        expectFailure(Failure::usage, words, [&] {
            writePointCache(folder / name, header, [&](std::uint32_t) { return std::vector<vec3>(header.pointCount); });
        });
    };
    for (const std::string name : {"a.pc2", "a.mdd"}) {
        refuse(name, {0, 1}, {"0 points"});
        refuse(name, {1, 0}, {"0 frames"});
        refuse(name, {1u << 31, 1}, {"2147483648 points"});
        refuse(name, {1, 1u << 31}, {"2147483648 frames"});
        refuse(name, {1, 1, std::nan("")}, {"start"});
        refuse(name, {1, 1, 1e10}, {"start"});
    }
    refuse("a.pc2", {1, 1, 0.1}, {"start frame 0.1"});
    refuse("a.pc2", {1, 1, 16777217}, {"start frame 16777217"});
    refuse("a.mdd", {1, 3, 16777216, 1}, {"frame 16777217", "16777216 seconds"});
    expectFailure(Failure::usage, {"frames per second"}, [&] {
        writePointCache(folder / "a.mdd", {1, 1, 0, 0}, [](std::uint32_t) { return std::vector<vec3>(1); });
    });
    EXPECT_EQ(folder.fileCount(), 0u);
}

} // namespace
} // namespace relief::test

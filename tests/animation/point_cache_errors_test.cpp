// Every point cache that must be refused, with the words that its message owes to the reader.
#include "animation/caches.h"

#include <cmath>
#include <limits>

namespace relief::test {
namespace {

constexpr std::endian kLittle = std::endian::little, kBig = std::endian::big;
const float kInfinity = std::numeric_limits<float>::infinity();

/// A valid file of three frames of a cube, from frame 10.
struct ValidCache {
    std::string name, bytes;

    [[nodiscard]] ValidCache with(std::size_t offset, const std::string& other) const {
        return {name, std::string(bytes).replace(offset, other.size(), other)};
    }
    [[nodiscard]] ValidCache cut(std::size_t length) const { return {name, bytes.substr(0, length)}; }
    [[nodiscard]] ValidCache longer(const std::string& more) const { return {name, bytes + more}; }
};

ValidCache makeCache(const std::string& name) {
    const TemporaryFolder folder;
    writeFrames(folder / name, cube(), 3, 10);
    return {name, readFile(folder / name)};
}

ValidCache pc2() { return makeCache("a.pc2"); }
ValidCache mdd() { return makeCache("a.mdd"); }

constexpr std::size_t kPc2Frame = 32, kMddFrame = 20, kFrameBytes = 96;

void expectRefused(const ValidCache& cache, std::vector<std::string> words) {
    const TemporaryFolder folder;
    const std::string path = folder / cache.name;
    putFile(path, cache.bytes);
    words.push_back(path + ": ");
    expectFailure(Failure::input, words, [&] { readQuietly(path, cube()); });
}

/// The file opens; reading this frame fails.
void expectRefusedAt(const ValidCache& cache, double frame, std::vector<std::string> words) {
    const TemporaryFolder folder;
    const std::string path = folder / cache.name;
    putFile(path, cache.bytes);
    words.push_back(path + ": ");
    const auto animation = readQuietly(path, cube());
    expectFailure(Failure::input, words, [&] { (void)animation->pose(frame / 24); });
}

TEST(PointCacheErrors, areTestedOnFilesThatAreValidBefore) {
    const TemporaryFolder folder;
    for (const ValidCache& cache : {pc2(), mdd()}) {
        putFile(folder / cache.name, cache.bytes);
        EXPECT_TRUE(
            haveSameBits(readQuietly(folder / cache.name, cube())->pose(12 / 24.0).positions, movedPoints(cube(), 12)));
    }
}

TEST(PointCacheErrors, nameFilesThatCannotBeRead) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "a.pc2");
    std::filesystem::create_directory(folder / "a.mdd");
    for (const std::string name : {"none.pc2", "none.mdd"})
        expectFailure(Failure::file, {folder / name, "No such file"}, [&] { readQuietly(folder / name, cube()); });
    for (const std::string name : {"a.pc2", "a.mdd"})
        expectFailure(Failure::file, {folder / name, "directory"}, [&] { readQuietly(folder / name, cube()); });
}

TEST(PointCacheErrors, nameFilesOfAnotherKind) {
    expectRefused(pc2().with(0, "POINTCACHE3"), {"no .pc2", "POINTCACHE2"});
    expectRefused({"a.pc2", mdd().bytes}, {"no .pc2"});
    expectRefused({"a.mdd", pc2().bytes}, {"points per frame", "the cage has 8"});
    expectRefused({"a.pc2", "v 0 0 0\n"}, {"no .pc2"});
    expectRefused(pc2().with(12, word(2u, kLittle)), {"version 2", "only 1"});
    expectRefused(pc2().with(12, word(0xffffffffu, kLittle)), {"version -1"});
}

TEST(PointCacheErrors, nameFilesThatAreCutInTheHeader) {
    for (const std::size_t length : {0, 1, 12, 31})
        expectRefused(pc2().cut(length), {"ends in its header", fmt::format("{} bytes of 32", length)});
    for (const std::size_t length : {0, 7}) expectRefused(mdd().cut(length), {"ends in its header", "of 8"});
    for (const std::size_t length : {8, 19}) expectRefused(mdd().cut(length), {"ends in its header", "of 20"});
}

TEST(PointCacheErrors, sayBothCountsOfPoints) {
    for (const std::uint32_t count : {7u, 9u, 0u, 1u << 30}) {
        const std::string words = fmt::format("{} points", count);
        expectRefused(pc2().with(16, word(count, kLittle)), {words, "the cage has 8"});
        expectRefused(mdd().with(4, word(count, kBig)), {words, "the cage has 8"});
    }
    expectRefused(pc2().with(16, word(0xfffffff8u, kLittle)), {"-8 points", "the cage has 8"});
    expectRefused(mdd().with(4, word(0xfffffff8u, kBig)), {"-8 points", "the cage has 8"});
}

TEST(PointCacheErrors, nameByteSwappedHeaders) {
    expectRefused(pc2().with(12, word(1u, kBig)), {"looks byte-swapped", "little endian"});
    expectRefused(pc2().with(16, word(8u, kBig)), {"looks byte-swapped", "the cage has 8"});
    expectRefused(mdd().with(0, word(3u, kLittle) + word(8u, kLittle)), {"looks byte-swapped", "the cage has 8"});
}

TEST(PointCacheErrors, nameImpossibleCountsOfFrames) {
    const std::vector<std::pair<std::uint32_t, std::string>> counts = {
        {0u, "0 frames"}, {1u << 31, "-2147483648 frames"}, {0xffffffffu, "-1 frames"}};
    for (const auto& [count, words] : counts) {
        expectRefused(pc2().with(28, word(count, kLittle)), {words, "1 to 2147483647"});
        expectRefused(mdd().with(0, word(count, kBig)), {words, "1 to 2147483647"});
    }
}

TEST(PointCacheErrors, takeNoMemoryForFramesThatAreNotThere) {
    expectRefused(pc2().with(28, word(0x7fffffffu, kLittle)), {"after 3 whole frames of 2147483647"});
    expectRefused(mdd().with(0, word(0x7fffffffu, kBig)), {"ends in its header", "8589934596"});
}

TEST(PointCacheErrors, nameFilesThatAreTooShortOrTooLong) {
    expectRefused(pc2().cut(kPc2Frame + 3 * kFrameBytes - 1), {"after 2 whole frames of 3"});
    expectRefused(pc2().cut(kPc2Frame), {"after 0 whole frames of 3"});
    expectRefused(mdd().cut(kMddFrame + 2 * kFrameBytes), {"after 2 whole frames of 3"});
    expectRefused(pc2().longer("x"), {"goes on for 1 bytes", "3 frames"});
    expectRefused(mdd().longer(std::string(kFrameBytes, 'x')), {"goes on for 96 bytes", "3 frames"});
    expectRefused(mdd().with(0, word(2u, kBig)), {"goes on for 100 bytes", "2 frames"});
}

TEST(PointCacheErrors, nameRatesAndStartsThatMakeNoTimes) {
    for (const float rate : {0.0f, -0.0f, -1.0f, 1e-30f, 1e-4f, 1e30f, kInfinity, -kInfinity, std::nanf("")})
        expectRefused(pc2().with(24, word(rate, kLittle)),
                      {"sample rate is " + fmt::format("{}", rate), "0.001 to 1000", "--cache-frames"});
    for (const float start : {kInfinity, -kInfinity, std::nanf("")})
        expectRefused(pc2().with(20, word(start, kLittle)), {"start frame is " + fmt::format("{}", start), "finite"});
    // So far out that doubles do not separate a frame from the next.
    expectRefused(pc2().with(20, word(1e30f, kLittle)), {"frame 1", "times must rise"});
}

TEST(PointCacheErrors, nameTimesThatDoNotRise) {
    const float first = 10 / 24.0f;
    expectRefused(mdd().with(12, word(first, kBig)), {"frame 1", "times must rise"});
    expectRefused(mdd().with(16, word(-1.0f, kBig)), {"frame 2", "-1 seconds", "times must rise"});
    for (const float time : {kInfinity, -kInfinity, std::nanf("")})
        expectRefused(mdd().with(12, word(time, kBig)), {"frame 1", fmt::format("{} seconds", time), "finite"});
    expectRefused(mdd().with(8, std::string(12, '\0')), {"frame 1", "0 seconds", "times must rise", "--cache-frames"});
}

TEST(PointCacheErrors, nameFrameAndPointOfPositionsThatAreNotFinite) {
    for (const float value : {kInfinity, -kInfinity, std::nanf(""), -std::nanf("")}) {
        const std::string shown = fmt::format("{}", value);
        expectRefusedAt(pc2().with(kPc2Frame + 2 * kFrameBytes + 12 * 5 + 4, word(value, kLittle)), 12,
                        {"frame 12", "point 5", shown});
        expectRefusedAt(mdd().with(kMddFrame + kFrameBytes + 12 * 7 + 8, word(value, kBig)), 11,
                        {"frame 1", "point 7", shown});
    }
    // A bad frame is as bad where a pose is between it and a good one.
    const ValidCache bad = pc2().with(kPc2Frame + kFrameBytes, word(kInfinity, kLittle));
    expectRefusedAt(bad, 10.5, {"frame 11", "point 0"});
    expectRefusedAt(bad, 11.5, {"frame 11", "point 0"});
}

// --- whatever the bytes --------------------------------------------------------------------------------------------

/// Poses that are asked for are there or an Error says why.
void expectPosesOrErrors(const ValidCache& cache, const std::string& path) {
    putFile(path, cache.bytes);
    try {
        const auto animation = readQuietly(path, cube());
        const dvec2 range = animation->keyRange();
        EXPECT_LE(range.x, range.y);
        for (const double share : {-1.0, 0.0, 0.3, 0.5, 1.0, 2.0})
            for (const vec3& p : animation->pose(range.x + share * (range.y - range.x)).positions)
                EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    } catch (const Error& error) {
        EXPECT_EQ(error.failure, Failure::input) << error.what();
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
}

TEST(PointCacheErrors, areAllThatComesOfFlippedBytes) {
    const TemporaryFolder folder;
    for (const ValidCache& valid : {pc2(), mdd()})
        for (std::size_t offset = 0; offset < kPc2Frame + 12; ++offset) // headers and a point
            for (const int flip : {1, 16, 128, 255})
                expectPosesOrErrors(valid.with(offset, std::string(1, char(valid.bytes[offset] ^ flip))),
                                    folder / valid.name);
}

TEST(PointCacheErrors, areAllThatComesOfCutFiles) {
    const TemporaryFolder folder;
    for (const ValidCache& valid : {pc2(), mdd()})
        for (std::size_t length = 0; length < valid.bytes.size(); length += length < kPc2Frame ? 1 : 11) {
            putFile(folder / valid.name, valid.cut(length).bytes);
            expectFailure(Failure::input, {folder / valid.name, "file ends"},
                          [&] { readQuietly(folder / valid.name, cube()); });
        }
}

} // namespace
} // namespace relief::test

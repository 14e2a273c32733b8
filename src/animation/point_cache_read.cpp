#include <algorithm>
#include <cmath>
#include <limits>

#include "animation/frames.h"
#include "animation/keys.h"
#include "animation/point_cache.h"

namespace relief {
namespace {

constexpr int kMostFrames = std::numeric_limits<std::int32_t>::max();
constexpr float kLeastRate = 1e-3f, kMostRate = 1e3f; ///< frames per sample: slower or faster is damage
constexpr const char* kCountFrames = "--cache-frames takes its frame k as frame k";

/// Words of a file, wherever they are asked for.
class CacheFile {
public:
    CacheFile(std::string path, std::endian order) : file_(std::move(path)), order_(order) {}

    [[nodiscard]] const std::string& path() const { return file_.path(); }
    [[nodiscard]] std::uint64_t size() const { return file_.size(); }

    std::string bytes(std::uint64_t offset, std::size_t count) {
        std::string bytes(count, '\0');
        read(offset, bytes.data(), count);
        return bytes;
    }

    std::vector<std::uint32_t> words(std::uint64_t offset, std::size_t count) {
        std::vector<std::uint32_t> words(count);
        read(offset, words.data(), 4 * count);
        for (std::uint32_t& word : words) word = inOrder(word, order_);
        return words;
    }

private:
    void read(std::uint64_t offset, void* bytes, std::size_t count) {
        if (file_.read(offset, bytes, count) != count)
            fail(Failure::input, "{}: the file has been cut short while it was in use", path());
    }

    InputFile file_;
    std::endian order_;
};

/// Frames of floats, one after another, up to the file's end.
struct CacheBody {
    std::uint64_t offset = 0;
    std::size_t pointCount = 0, frameCount = 0;
    Coordinates coordinates; ///< that positions are wanted in; the file's are the world's
};

class CacheReader : public KeyReader {
public:
    CacheReader(CacheFile file, const CacheBody& body, double startFrame, double frameStep)
        : file_(std::move(file)), body_(body), startFrame_(startFrame), frameStep_(frameStep) {}

    [[nodiscard]] std::string name(std::size_t key) const override {
        return fmt::format("{}: frame {}", file_.path(), startFrame_ + double(key) * frameStep_);
    }

    std::vector<vec3> read(std::size_t key) override {
        const std::size_t wordCount = 3 * body_.pointCount;
        const std::vector<std::uint32_t> words = file_.words(body_.offset + 4 * key * wordCount, wordCount);
        std::vector<vec3> positions(body_.pointCount);
        for (std::size_t i = 0; i < wordCount; ++i) positions[i / 3][int(i % 3)] = std::bit_cast<float>(words[i]);
        for (vec3& p : positions) p = body_.coordinates.toLocal(p);
        return positions;
    }

private:
    CacheFile file_;
    CacheBody body_;
    double startFrame_, frameStep_;
};

void checkPointCount(const std::string& path, std::uint32_t count, std::size_t expected) {
    if (count == expected && count > 0) return;
    if (__builtin_bswap32(count) == expected)
        fail(Failure::input,
             "{}: the file looks byte-swapped ({} points, the cage has {}); .pc2 is little endian, .mdd big", path,
             std::int32_t(count), expected);
    fail(Failure::input,
         "{}: there are {} points per frame, the cage has {}; use the cage that the cache was made from", path,
         std::int32_t(count), expected);
}

void checkFrameCount(const std::string& path, std::uint32_t count) {
    if (std::int32_t(count) < 1)
        fail(Failure::input, "{}: there are {} frames; 1 to {} are possible", path, std::int32_t(count), kMostFrames);
}

void checkHeaderLength(const CacheFile& file, std::uint64_t headerBytes) {
    if (file.size() < headerBytes)
        fail(Failure::input, "{}: the file ends in its header, after {} bytes of {}", file.path(), file.size(),
             headerBytes);
}

void checkBodyLength(const CacheFile& file, const CacheBody& body) {
    checkHeaderLength(file, body.offset);
    const std::uint64_t bytes = file.size() - body.offset, frameBytes = 12 * body.pointCount;
    const std::uint64_t wholeFrames = bytes / frameBytes;
    if (wholeFrames < body.frameCount)
        fail(Failure::input, "{}: the file ends after {} whole frames of {}; write it again", file.path(), wholeFrames,
             body.frameCount);
    const std::uint64_t more = bytes - body.frameCount * frameBytes;
    if (more > 0)
        fail(Failure::input, "{}: the file goes on for {} bytes after the last of {} frames", file.path(), more,
             body.frameCount);
}

Bounds firstBounds(CacheFile& file, const CacheBody& body) {
    const std::vector<std::uint32_t> words = file.words(body.offset, 3 * body.pointCount);
    Bounds bounds;
    for (std::size_t i = 0; i < words.size(); i += 3)
        bounds.add(
            {std::bit_cast<float>(words[i]), std::bit_cast<float>(words[i + 1]), std::bit_cast<float>(words[i + 2])});
    return bounds;
}

std::unique_ptr<Animation> readPc2(const std::string& path, const Cage& cage, const CacheOptions& options) {
    CacheFile file(path, kPc2Order);
    const std::string magic = file.bytes(0, std::min<std::size_t>(file.size(), kPc2Magic.size()));
    if (!kPc2Magic.starts_with(magic))
        fail(Failure::input, "{}: this is no .pc2: it does not start with POINTCACHE2", path);
    checkHeaderLength(file, kPc2HeaderBytes);

    // What the header says.
    const std::vector<std::uint32_t> words = file.words(kPc2Magic.size(), 5);
    const std::uint32_t version = words[0], pointCount = words[1], sampleCount = words[4];
    const float start = std::bit_cast<float>(words[2]), rate = std::bit_cast<float>(words[3]);
    if (version == 1u << 24)
        fail(Failure::input, "{}: the file looks byte-swapped (version {}); .pc2 is little endian", path, version);
    if (version != 1) fail(Failure::input, "{}: version {} of .pc2; only 1 is known", path, std::int32_t(version));
    checkPointCount(path, pointCount, cage.positions.size());
    if (!options.countsFrames && !std::isfinite(start))
        fail(Failure::input, "{}: the start frame is {}; a finite number is needed", path, start);
    if (!options.countsFrames && !(rate >= kLeastRate && rate <= kMostRate))
        fail(Failure::input, "{}: the sample rate is {} frames per sample; {} to {} are possible; {}", path, rate,
             kLeastRate, kMostRate, kCountFrames);
    checkFrameCount(path, sampleCount);
    // Where its samples are, and when.
    CacheBody body{.offset = kPc2HeaderBytes,
                   .pointCount = pointCount,
                   .frameCount = sampleCount,
                   .coordinates = cage.coordinates};
    checkBodyLength(file, body);
    body.coordinates = keyCoordinates(cage.coordinates, firstBounds(file, body));

    const double first = options.countsFrames ? 0 : start, step = options.countsFrames ? 1 : rate;
    KeyTimes times{.seconds = {}, .remedy = kCountFrames};
    for (std::size_t i = 0; i < sampleCount; ++i) times.seconds.push_back((first + double(i) * step) / options.fps);
    auto reader = std::make_unique<CacheReader>(std::move(file), body, first, step);
    return animateKeys(std::move(reader), std::move(times), {options.interpolation, body.coordinates});
}

std::unique_ptr<Animation> readMdd(const std::string& path, const Cage& cage, const CacheOptions& options) {
    CacheFile file(path, kMddOrder);
    checkHeaderLength(file, 8);
    const std::vector<std::uint32_t> words = file.words(0, 2);
    const std::uint32_t frameCount = words[0], pointCount = words[1];
    checkPointCount(path, pointCount, cage.positions.size());
    checkFrameCount(path, frameCount);
    CacheBody body{.offset = 8 + 4ull * frameCount,
                   .pointCount = pointCount,
                   .frameCount = frameCount,
                   .coordinates = cage.coordinates};
    checkBodyLength(file, body);
    body.coordinates = keyCoordinates(cage.coordinates, firstBounds(file, body));

    KeyTimes times{.seconds = {}, .areFloats = !options.countsFrames, .remedy = kCountFrames};
    times.seconds.reserve(frameCount);
    for (const std::uint32_t word : file.words(8, frameCount))
        times.seconds.push_back(options.countsFrames ? double(times.seconds.size()) / options.fps
                                                     : std::bit_cast<float>(word));
    auto reader = std::make_unique<CacheReader>(std::move(file), body, 0, 1);
    return animateKeys(std::move(reader), std::move(times), {options.interpolation, body.coordinates});
}

std::unique_ptr<Animation> readByName(const std::string& path, const Cage& cage, const CacheOptions& options) {
    if (isFramePattern(path)) return readCageSequence(path, cage, options);
    const std::string extension = lowerExtension(path);
    if (extension == ".pc2") return readPc2(path, cage, options);
    if (extension == ".mdd") return readMdd(path, cage, options);
    fail(Failure::input, "{}: unknown kind of point cache '{}'; use .pc2, .mdd or a sequence, 'cage.{{frame:4}}.obj'",
         path, extension);
}

} // namespace

void warnOfCoarseFloats(const std::string& path, const Cage& cage, const dvec3& origin, const Warn& warn) {
    constexpr double kCoarse = 1e-5; // of the cage's size: from there on it can be seen
    const double size = summarize(cage).bounds.diagonal(), spacing = floatSpacing(origin);
    if (origin == dvec3(0) || spacing <= kCoarse * size) return;
    warn(fmt::format("{}: the 32-bit floats of a point cache are {:.2g} units apart so far from the origin, and the "
                     "cage is {:.2g} units large; move both nearer to it",
                     path, spacing, size));
}

std::unique_ptr<Animation> readPointCache(const std::string& path, const Cage& cage, const CacheOptions& options,
                                          const Warn& warn) {
    checkFps(options.fps);
    auto animation = readByName(path, cage, options);
    const dvec2 range = animation->keyRange();
    if (range.x == range.y) warn(fmt::format("{}: there is only one frame, so nothing moves", path));
    if (!isFramePattern(path)) warnOfCoarseFloats(path, cage, animation->coordinates().origin, warn);
    return animation;
}

} // namespace relief

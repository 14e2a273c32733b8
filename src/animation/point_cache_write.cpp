#include "animation/point_cache.h"

#include <cerrno>
#include <cmath>
#include <fstream>
#include <limits>
#include <system_error>

#include "animation/keys.h"

namespace relief {
namespace {

constexpr std::uint32_t kMostCounted = std::numeric_limits<std::int32_t>::max();

void putWord(std::string& bytes, std::uint32_t word, std::endian order) {
    word = inOrder(word, order);
    bytes.append(reinterpret_cast<const char*>(&word), sizeof word);
}

void putFloat(std::string& bytes, float value, std::endian order) {
    putWord(bytes, std::bit_cast<std::uint32_t>(value), order);
}

void checkHeader(const std::string& path, const CacheHeader& header) {
    for (const std::uint32_t count : {header.pointCount, header.frameCount})
        if (count < 1 || count > kMostCounted)
            fail(Failure::usage, "{}: not written: {} frames of {} points; 1 to {} of both are possible", path,
                 header.frameCount, header.pointCount, kMostCounted);
    if (!(std::abs(header.startFrame) <= kMostCounted))
        fail(Failure::usage, "{}: not written: it would start at frame {}; up to {} is possible", path,
             header.startFrame, kMostCounted);
    checkFps(header.fps);
}

std::string pc2Header(const std::string& path, const CacheHeader& header) {
    const auto start = float(header.startFrame);
    if (start != header.startFrame)
        fail(Failure::usage, "{}: not written: start frame {} is no 32-bit float; use .mdd or another frame", path,
             header.startFrame);
    std::string bytes(kPc2Magic);
    putWord(bytes, 1, kPc2Order);
    putWord(bytes, header.pointCount, kPc2Order);
    putFloat(bytes, start, kPc2Order);
    putFloat(bytes, 1, kPc2Order); // frames per sample
    putWord(bytes, header.frameCount, kPc2Order);
    return bytes;
}

std::string mddHeader(const std::string& path, const CacheHeader& header) {
    std::string bytes;
    putWord(bytes, header.frameCount, kMddOrder);
    putWord(bytes, header.pointCount, kMddOrder);
    float before = -std::numeric_limits<float>::infinity();
    for (std::uint32_t k = 0; k < header.frameCount; ++k) {
        const auto seconds = float((header.startFrame + k) / header.fps);
        if (seconds <= before)
            fail(Failure::usage, "{}: not written: frame {} and the one before it would both be at {} seconds", path,
                 header.startFrame + k, seconds);
        putFloat(bytes, seconds, kMddOrder);
        before = seconds;
    }
    return bytes;
}

std::string frameBytes(const std::vector<vec3>& positions, std::endian order) {
    std::string bytes;
    bytes.reserve(12 * positions.size());
    for (const vec3& p : positions)
        for (int k = 0; k < 3; ++k) putFloat(bytes, p[k], order);
    return bytes;
}

} // namespace

void writePointCache(const std::string& path, const CacheHeader& header,
                     const std::function<std::vector<vec3>(std::uint32_t)>& positions) {
    const std::string extension = lowerExtension(path);
    const bool isPc2 = extension == ".pc2";
    if (!isPc2 && extension != ".mdd")
        fail(Failure::usage, "{}: unknown kind of point cache '{}'; use .pc2 or .mdd", path, extension);
    checkHeader(path, header);

    // Errors throw out of writeWhole, which then leaves the target as it was.
    writeWhole(path, [&](const std::string& temporary) {
        std::ofstream file(temporary, std::ios::binary);
        const auto check = [&] {
            if (!file) fail(Failure::file, "{}: cannot be written: {}", path, std::generic_category().message(errno));
        };
        const auto put = [&](const std::string& bytes) {
            file.write(bytes.data(), std::streamsize(bytes.size()));
            check();
        };
        // Pose after pose: memory holds one at a time.
        put(isPc2 ? pc2Header(path, header) : mddHeader(path, header));
        for (std::uint32_t k = 0; k < header.frameCount; ++k) {
            const std::vector<vec3> pose = positions(k);
            const std::string frame = fmt::format("{}: not written: frame {}", path, header.startFrame + k);
            if (pose.size() != header.pointCount)
                fail(Failure::input, "{} has {} points, {} expected", frame, pose.size(), header.pointCount);
            checkFinite(pose, frame);
            put(frameBytes(pose, isPc2 ? kPc2Order : kMddOrder));
        }
        file.close();
        check(); // a full disk may show only here
    });
}

} // namespace relief

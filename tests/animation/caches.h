// What tests of point caches share.
#pragma once

#include <bit>
#include <cstring>

#include "animation/animation.h"
#include "meshes.h"
#include "support.h"

namespace relief::test {

/// The cage's points at frame k: moved, stretched, and with bits that no rounding keeps.
inline std::vector<vec3> movedPoints(const Cage& cage, double frame) {
    std::vector<vec3> points;
    for (std::size_t i = 0; i < cage.positions.size(); ++i)
        points.emplace_back(dvec3(cage.positions[i]) * (1 + 0.1 * frame) + dvec3(frame / 3, 0.1 * double(i), -frame));
    return points;
}

inline void writeFrames(const std::string& path, const Cage& cage, std::uint32_t frameCount, double startFrame = 0,
                        double fps = 24) {
    const CacheHeader header{std::uint32_t(cage.positions.size()), frameCount, startFrame, fps};
    writePointCache(path, header, [&](std::uint32_t k) { return movedPoints(cage, startFrame + k); });
}

/// Reads a point cache and ignores its warnings.
inline std::unique_ptr<Animation> readQuietly(const std::string& path, const Cage& cage,
                                              const CacheOptions& options = {}) {
    return readPointCache(path, cage, options, [](const std::string&) {});
}

inline bool haveSameBits(const std::vector<vec3>& a, const std::vector<vec3>& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(vec3)) == 0;
}

/// Expects all coordinates to agree within `tolerance`.
inline void expectNear(const std::vector<vec3>& a, const std::vector<vec3>& b, double tolerance) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(a[i][k], b[i][k], tolerance) << "point " << i << ", coordinate " << k;
}

inline std::string word(std::uint32_t value, std::endian order) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) bytes += char(value >> 8 * (order == std::endian::little ? i : 3 - i));
    return bytes;
}

inline std::string word(float value, std::endian order) { return word(std::bit_cast<std::uint32_t>(value), order); }

} // namespace relief::test

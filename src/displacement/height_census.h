// Which texels of an image are heights and which are voids.
#pragma once

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include "base/base.h"

namespace relief {

/// Counts what the texels of one channel are, before anything is stored of them.
/// A void is a texel that holds the number of the file's GDAL_NODATA (TIFF) or tRNS (PNG). In files whose samples have
/// a unit, voids are also -9999, -32767, -32768, -99999, -2147483648 and numbers beyond +-1e30, each only where it
/// stands apart: farther from all other heights than these span.
class HeightCensus {
public:
    explicit HeightCensus(const ImageInfo& info);
    void add(float texel);
    void finish(); ///< call it after the last texel

    [[nodiscard]] bool isVoid(float texel) const;
    [[nodiscard]] std::uint64_t voidCount() const;
    /// Why they are voids: "-9999 by its GDAL_NODATA"; "" without voids.
    [[nodiscard]] std::string voidReason() const;
    /// Range of all texels that are finite and no voids; lowest > highest where there are none.
    [[nodiscard]] float lowest() const { return lowest_; }
    [[nodiscard]] float highest() const { return highest_; }
    /// NaN and infinities that are no voids, and the number of the first one in the order of `add`.
    [[nodiscard]] std::uint64_t notFiniteCount() const { return notFiniteCount_; }
    [[nodiscard]] std::uint64_t firstNotFinite() const { return firstNotFinite_; }

private:
    static constexpr std::array<float, 5> kCustomary = {-9999, -32767, -32768, -99999, -2147483648.0f};
    static constexpr std::size_t kNoCustom = kCustomary.size(), kHugeLow = kNoCustom + 1, kHugeHigh = kNoCustom + 2;
    struct Custom {
        std::uint64_t count = 0;
        float lowest = INFINITY, highest = -INFINITY;
        bool isVoid = false;
    };
    [[nodiscard]] bool isNoData(float texel) const;
    [[nodiscard]] std::size_t customOf(float texel) const;

    bool takesCustomary_;
    const char* noDataTag_;       ///< what the file says it by
    std::optional<float> noData_; ///< as texels hold it
    double fileSays_ = 0;
    float slack_ = 0;
    std::uint64_t count_ = 0, noDataCount_ = 0, notFiniteCount_ = 0, firstNotFinite_ = 0;
    std::array<Custom, kCustomary.size() + 2> custom_;
    float lowest_ = INFINITY, highest_ = -INFINITY;
};

} // namespace relief

// Voids of elevation models: found by what the file says or by customary numbers, filled from around.
#include "displacement/voids.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace relief {
namespace {

constexpr float kHuge = 1e30f; ///< beyond any height: lowest float, 9.97e36 (netCDF)

double largestStored(const ImageInfo& info) { return std::exp2(8.0 * info.sampleBytes) - 1; }

/// One level of the pyramid: means of heights, and how much of each texel they cover, 0..1.
struct FillLevel {
    int width = 0, height = 0;
    std::vector<float> means, shares;

    [[nodiscard]] std::size_t at(int x, int y) const {
        return std::size_t(std::clamp(y, 0, height - 1)) * std::size_t(width) +
               std::size_t(std::clamp(x, 0, width - 1));
    }
};

/// The level above one of that size, of which `meanAt` and `shareAt` say what is known.
template <typename MeanAt, typename ShareAt>
FillLevel coarser(int width, int height, const MeanAt& meanAt, const ShareAt& shareAt) {
    FillLevel coarse{(width + 1) / 2, (height + 1) / 2, {}, {}};
    coarse.means.reserve(std::size_t(coarse.width) * std::size_t(coarse.height));
    coarse.shares.reserve(coarse.means.capacity());
    for (int y = 0; y < coarse.height; ++y)
        for (int x = 0; x < coarse.width; ++x) {
            double sum = 0, share = 0;
            for (int k = 0; k < 4; ++k) {
                const int column = 2 * x + k % 2, row = 2 * y + k / 2;
                if (column >= width || row >= height) continue;
                const std::size_t i = std::size_t(row) * std::size_t(width) + std::size_t(column);
                sum += double(shareAt(i)) * double(meanAt(i));
                share += double(shareAt(i));
            }
            coarse.means.push_back(share > 0 ? float(sum / share) : 0);
            coarse.shares.push_back(float(std::min(share, 1.0)));
        }
    return coarse;
}

FillLevel coarser(const FillLevel& fine) {
    return coarser(
        fine.width, fine.height, [&](std::size_t i) { return fine.means[i]; },
        [&](std::size_t i) { return fine.shares[i]; });
}

/// Bilinear at the centre of texel (x,y) of the level before, whose four texels lie a quarter beside the centre.
float meanAround(const FillLevel& coarse, int x, int y) {
    const int left = (x - 1) >> 1, top = (y - 1) >> 1;
    const float fx = x % 2 == 0 ? 0.75f : 0.25f, fy = y % 2 == 0 ? 0.75f : 0.25f;
    const auto mean = [&](int column, int row) { return coarse.means[coarse.at(column, row)]; };
    const float upper = std::lerp(mean(left, top), mean(left + 1, top), fx);
    const float lower = std::lerp(mean(left, top + 1), mean(left + 1, top + 1), fx);
    return std::lerp(upper, lower, fy);
}

/// What the texels of `fine` do not cover is taken from the filled level above.
void pull(FillLevel& fine, const FillLevel& coarse) {
    for (int y = 0; y < fine.height; ++y)
        for (int x = 0; x < fine.width; ++x) {
            const std::size_t i = fine.at(x, y);
            if (fine.shares[i] < 1) fine.means[i] = std::lerp(meanAround(coarse, x, y), fine.means[i], fine.shares[i]);
        }
}

} // namespace

void fillVoids(int width, int height, std::span<float> texels, const std::vector<bool>& isVoid) {
    RELIEF_CHECK(texels.size() == std::size_t(width) * std::size_t(height));
    RELIEF_CHECK(isVoid.size() == texels.size());
    if (texels.size() <= 1) return;
    // Push: the finest level is the map itself, whose voids cover nothing; it is not copied.
    std::vector<FillLevel> levels;
    levels.push_back(coarser(
        width, height, [&](std::size_t i) { return isVoid[i] ? 0.0f : texels[i]; },
        [&](std::size_t i) { return isVoid[i] ? 0.0f : 1.0f; }));
    while (levels.back().means.size() > 1) levels.push_back(coarser(levels.back()));
    // Pull: from the coarsest level, which is one mean of all heights.
    for (std::size_t level = levels.size() - 1; level-- > 0;) pull(levels[level], levels[level + 1]);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const std::size_t i = std::size_t(y) * std::size_t(width) + std::size_t(x);
            if (isVoid[i]) texels[i] = meanAround(levels.front(), x, y);
        }
}

HeightCensus::HeightCensus(const ImageInfo& info)
    : takesCustomary_(info.hasUnit()), noDataTag_(info.format == "png" ? "tRNS" : "GDAL_NODATA") {
    if (!info.noData) return;
    constexpr double kMost = std::numeric_limits<float>::max();
    fileSays_ = *info.noData;
    const double texel = info.hasUnit() ? *info.noData : *info.noData / largestStored(info);
    noData_ = float(std::clamp(texel, -kMost, kMost)); // NaN stays NaN
    if (std::isinf(*info.noData)) noData_ = float(*info.noData);
    slack_ = info.hasUnit() ? 0 : float(0.25 / largestStored(info));
}

bool HeightCensus::isNoData(float texel) const {
    if (!noData_) return false;
    return texel == *noData_ || std::abs(texel - *noData_) < slack_ || (std::isnan(texel) && std::isnan(*noData_));
}

std::size_t HeightCensus::customOf(float texel) const {
    if (!takesCustomary_ || (texel > kCustomary[0] && texel < kHuge)) return kNoCustom;
    if (std::abs(texel) >= kHuge) return texel < 0 ? kHugeLow : kHugeHigh;
    return std::size_t(std::ranges::find(kCustomary, texel) - kCustomary.begin()); // kNoCustom where there is none
}

void HeightCensus::add(float texel) {
    const std::uint64_t index = count_++;
    if (isNoData(texel)) {
        ++noDataCount_;
    } else if (!std::isfinite(texel)) {
        if (notFiniteCount_++ == 0) firstNotFinite_ = index;
    } else if (const std::size_t custom = customOf(texel); custom != kNoCustom) {
        Custom& c = custom_[custom < kNoCustom ? custom : custom - 1];
        ++c.count, c.lowest = std::min(c.lowest, texel), c.highest = std::max(c.highest, texel);
    } else {
        lowest_ = std::min(lowest_, texel), highest_ = std::max(highest_, texel);
    }
}

void HeightCensus::finish() {
    // From the smallest number on: what is taken for a height belongs to the rest from which the next must stand apart.
    for (Custom& c : custom_) {
        if (c.count == 0) continue;
        const bool isAlone = lowest_ > highest_;
        const double gap = c.highest < lowest_   ? double(lowest_) - double(c.highest)
                           : c.lowest > highest_ ? double(c.lowest) - double(highest_)
                                                 : 0;
        c.isVoid = !isAlone && gap > double(highest_) - double(lowest_);
        if (c.isVoid) continue;
        lowest_ = std::min(lowest_, c.lowest), highest_ = std::max(highest_, c.highest);
    }
}

bool HeightCensus::isVoid(float texel) const {
    if (isNoData(texel)) return true;
    if (!std::isfinite(texel)) return false;
    const std::size_t custom = customOf(texel);
    return custom != kNoCustom && custom_[custom < kNoCustom ? custom : custom - 1].isVoid;
}

std::uint64_t HeightCensus::voidCount() const {
    std::uint64_t count = noDataCount_;
    for (const Custom& c : custom_) count += c.isVoid ? c.count : 0;
    return count;
}

std::string HeightCensus::voidReason() const {
    std::string reason;
    if (noDataCount_ > 0) reason = fmt::format("{} by its {}", fileSays_, noDataTag_);
    for (const Custom& c : custom_)
        if (c.isVoid)
            reason +=
                fmt::format("{}{} that stands apart from all other heights", reason.empty() ? "" : ", ", c.lowest);
    return reason;
}

} // namespace relief

// When two pictures of values 0..1 are the same: drawn by one driver, and drawn by two.
#pragma once

#include <algorithm>
#include <cmath>
#include <ostream>
#include <utility>

#include "base/base.h"

namespace relief::test {

struct Comparison {
    std::size_t valueCount = 0;
    std::size_t visibleCount = 0, wrongCount = 0; ///< differ by more than kVisible, kWrong
    float largest = 0;
    std::size_t strayCount = 0; ///< are further than kStray outside what the golden has within a pixel
    double calmMean = 0; ///< mean difference in codes where the golden is calm, each counted as two codes at most
    Image tenfold;       ///< ten times the difference
};

inline std::ostream& operator<<(std::ostream& stream, const Comparison& c) {
    return stream << fmt::format(
               "of {} values {} differ by over one code, {} by over three, the most by {:.1f}; {} stray; "
               "where the golden is calm the mean difference is {:.4f} codes",
               c.valueCount, c.visibleCount, c.wrongCount, 255 * c.largest, c.strayCount, c.calmMean);
}

// --- one driver --------------------------------------------------------------------------------------------------

/// OpenImageIO's rule for "the same picture": one code of 8 bits is 0.0039. relief rounds in its own arithmetic
/// whatever a format would round, so on processors of two vendors one driver's pictures differ by less; a code is for
/// values that lie on the edge between two.
constexpr float kVisible = 0.004f, kWrong = 0.012f;
constexpr double kVisibleShare = 0.0002;

inline bool isSame(const Comparison& c) {
    return c.wrongCount == 0 && double(c.visibleCount) <= kVisibleShare * double(c.valueCount);
}

// --- two drivers -------------------------------------------------------------------------------------------------

/// Drivers place vertices on grids of their own (SwiftShader on 1/16 of a pixel, Mesa's on 1/256) and so cover the
/// pixels of an outline differently: there a value must lie, but for kStray, in the range of the golden's 3 x 3 pixels
/// around it. Shadows and creases end within a pixel and may do so in another one, which leaves some strays.
constexpr float kStray = 4.5f / 255;
constexpr double kStrayShare = 0.004;

/// Everywhere else both compute the same numbers and round some of them to the next code. Pixels are calm whose 3 x 3
/// differ by no more than kCalm; there the mean difference was at most 0.03 codes, and 0.06 and more for real changes.
constexpr float kCalm = 24.5f / 255, kMost = 2.0f / 255;
constexpr double kCalmMean = 0.045;

inline bool isSameOfAnotherDriver(const Comparison& c, double calmMean = kCalmMean) {
    return c.calmMean <= calmMean && double(c.strayCount) <= kStrayShare * double(c.valueCount);
}

/// Lowest and highest value of a channel in the 3 x 3 pixels around one.
inline std::pair<float, float> rangeAround(const Image& image, int x, int y, int channel) {
    std::pair<float, float> range = {1.0f, 0.0f};
    for (int j = std::max(y - 1, 0); j <= std::min(y + 1, image.height - 1); ++j)
        for (int i = std::max(x - 1, 0); i <= std::min(x + 1, image.width - 1); ++i) {
            const float value = image.at(i, j)[channel];
            range = {std::min(range.first, value), std::max(range.second, value)};
        }
    return range;
}

// --- both --------------------------------------------------------------------------------------------------------

inline Comparison compare(const Image& drawn, const Image& golden) {
    Comparison result{.valueCount = golden.texels.size(), .tenfold = drawn};
    double calmSum = 0, calmCount = 0;
    for (int y = 0; y < golden.height; ++y)
        for (int x = 0; x < golden.width; ++x) {
            bool isCalm = true;
            float difference = 0; // of the pixel's channels together, each kMost at most
            for (int c = 0; c < golden.channels; ++c) {
                const float value = drawn.at(x, y)[c], d = std::abs(value - golden.at(x, y)[c]);
                const auto [low, high] = rangeAround(golden, x, y, c);
                result.visibleCount += d > kVisible;
                result.wrongCount += d > kWrong;
                result.largest = std::max(result.largest, d);
                result.strayCount += value < low - kStray || value > high + kStray;
                isCalm = isCalm && high - low < kCalm;
                difference += std::min(d, kMost);
                result.tenfold.at(x, y)[c] = c == 3 ? 1 : std::min(1.0f, 10 * d);
            }
            if (!isCalm) continue;
            calmSum += 255 * difference;
            calmCount += golden.channels;
        }
    result.calmMean = calmCount > 0 ? calmSum / calmCount : 0;
    return result;
}

} // namespace relief::test

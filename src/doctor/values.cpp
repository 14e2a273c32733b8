// What the values of a map show, wherever they lie.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "doctor/examiners.h"

namespace relief {
namespace {

double decodeSrgb(double code) { return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4); }
double encodeSrgb(double value) {
    return value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
}

bool isInteger16(const ImageInfo& info) { return info.sample == "uint16"; }

std::uint32_t stepOf(float value) { return std::uint32_t(std::lround(65535.0 * value)); }

/// The distinct values of all texels, in order; no more than one past `most`.
std::vector<float> listDistinct(const MapCase& map, std::size_t most) {
    std::vector<float> distinct;
    for (const float value : map.sorted) {
        if (!distinct.empty() && value == distinct.back()) continue;
        distinct.push_back(value);
        if (distinct.size() > most) break;
    }
    return distinct;
}

/// Whether all values are among the 256 that `curve` makes of k / 255, as near as the file's samples round.
bool areCodes(std::span<const float> values, const ImageInfo& info, double (*curve)(double)) {
    std::array<double, 256> codes;
    for (std::size_t k = 0; k < 256; ++k) codes[k] = curve(double(k) / 255);
    return std::ranges::all_of(values, [&](float value) {
        const auto next = std::ranges::lower_bound(codes, double(value));
        const double above = next == codes.end() ? INFINITY : std::abs(*next - value);
        const double below = next == codes.begin() ? INFINITY : std::abs(*(next - 1) - value);
        const double rounding = info.sample == "half" ? std::abs(value) / 2048 : 1e-5;
        return std::min(above, below) <= rounding;
    });
}

constexpr std::size_t kFewestCodes = 16; ///< fewer values than these are a pattern, not heights in steps

/// The greatest common divisor of the differences between 16-bit steps.
std::uint32_t commonStep(std::span<const float> values) {
    std::uint32_t divisor = 0;
    const std::uint32_t first = values.empty() ? 0 : stepOf(values.front());
    for (const float value : values) {
        const std::uint32_t step = stepOf(value);
        divisor = std::gcd(divisor, step > first ? step - first : first - step);
        if (divisor == 1) break;
    }
    return divisor;
}

void addSteps(const MapCase& map, Findings& findings, double bits, double step, const std::string& because) {
    findings.push_back({.kind = FindingKind::bitDepth,
                        .text = fmt::format("{}: steps of {:.3g} cage units", because, map.cageUnits(step)),
                        .advice = "export the map again from its source with 16 bits or as float",
                        .figure = bits});
}

} // namespace

void examineSteps(const MapCase& map, Findings& findings) {
    const double scale = std::abs(map.map.scale);
    // Files whose format says that they have 8 bits.
    if (map.info.format == "jpeg")
        return addSteps(map, findings, 8, scale / 255, "a JPEG, whose 8 bits are also rounded by blocks");
    if (map.info.sampleBytes == 1) return addSteps(map, findings, 8, scale / 255, "8 bits per height");

    // Integers that are all multiples of more than one step, and those that use few of their steps.
    const std::vector<float> distinct = listDistinct(map, 1u << 16);
    if (distinct.size() < kFewestCodes) return;
    if (isInteger16(map.info)) {
        const std::uint32_t step = commonStep(distinct);
        const double bits = std::log2(65536.0 / step), used = 65535 * map.storedRange();
        if (step >= 16)
            return addSteps(
                map, findings, bits, scale * step / 65535,
                fmt::format("the 16-bit file holds {:.0f}-bit data: all heights are multiples of {}", bits, step));
        if (used < 512)
            return addSteps(map, findings, std::log2(used + 1), scale / 65535,
                            fmt::format("the heights use {:.0f} of the file's 65536 steps", used + 1));
    } else if (map.info.hasUnit() && distinct.size() <= 256 &&
               areCodes(distinct, map.info, [](double x) { return x; })) {
        return addSteps(
            map, findings, 8, scale / 255,
            fmt::format("the {} file holds 8-bit data: all heights are multiples of 1/255", map.info.sample));
    }
}

// --- colors -------------------------------------------------------------------------------------------------------

Peak findPeak(std::span<const float> sorted, double width) {
    Peak peak;
    std::size_t last = 0;
    for (std::size_t first = 0; first < sorted.size(); ++first) {
        while (last < sorted.size() && sorted[last] <= sorted[first] + width) ++last;
        const double share = double(last - first) / double(sorted.size());
        if (share > peak.share) peak = {double(sorted[first + (last - first) / 2]), share};
    }
    return peak;
}

namespace {

/// Values within a thousandth of the range are one.
double peakWidth(const MapCase& map) { return std::max(0.001 * map.storedRange(), 1e-7); }

bool isNear(double value, double code) { return std::abs(value - code) < 0.0015; }

/// "encoded" or "decoded", by where the sRGB curve takes a midlevel of one half or 128/255; or nothing.
const char* describeCurve(double midlevel) {
    for (const double half : {0.5, 128.0 / 255}) {
        if (isNear(midlevel, encodeSrgb(half))) return "encoded";
        if (isNear(midlevel, decodeSrgb(half))) return "decoded";
    }
    return nullptr;
}

const char* kLinearAdvice = "export the heights as raw, non-color data without a conversion between sRGB and linear";

} // namespace

void examineColors(const MapCase& map, Findings& findings) {
    if (!map.info.colorTag.empty())
        findings.push_back({.kind = FindingKind::colors,
                            .isFault = false,
                            .text = fmt::format("the file says that its numbers are colors ({}); relief reads them as "
                                                "they are, other programs may convert them",
                                                map.info.colorTag),
                            .advice = "set the map to raw, non-color data in other programs"});
    // Values that all lie on the curve were 8-bit codes.
    const std::vector<float> distinct = listDistinct(map, 256);
    const bool isDecoded = distinct.size() >= kFewestCodes && distinct.size() <= 256 && map.info.sampleBytes > 1 &&
                           areCodes(distinct, map.info, decodeSrgb);
    if (isDecoded) {
        findings.push_back({.kind = FindingKind::colors,
                            .text = fmt::format("all {} heights are what the sRGB curve makes of multiples of 1/255: "
                                                "an 8-bit map was decoded as colors",
                                                distinct.size()),
                            .advice = kLinearAdvice,
                            .figure = double(distinct.size())});
        return;
    }
    // A midlevel that much of the map has, and that lies on the curve, says the same.
    const Peak peak = findPeak(map.used, peakWidth(map));
    const char* curve = describeCurve(peak.value);
    if (peak.share < kPeakShare || curve == nullptr || std::abs(peak.value - map.map.mid) < 0.002) return;
    findings.push_back(
        {.kind = FindingKind::colors,
         .text = fmt::format("{:.0f} % of the heights are {:.4g}, which is one half {} by the sRGB curve",
                             100 * peak.share, peak.value, curve),
         .advice = kLinearAdvice,
         .figure = peak.value});
}

// --- signs --------------------------------------------------------------------------------------------------------

namespace {

/// The mean difference of texels that are side by side in rows.
template <typename Value>
double meanStep(const HeightMap& map, const Value& value) {
    double sum = 0;
    for (std::size_t i = 1; i < map.texels.size(); ++i)
        if (i % std::size_t(map.width) != 0) sum += std::abs(value(map.texels[i]) - value(map.texels[i - 1]));
    return sum / double(map.texels.size());
}

} // namespace

void examineSigns(const MapCase& map, Findings& findings) {
    // Negative numbers as two's complement: next to 0 lies 65535.
    if (!map.info.hasUnit()) {
        const auto asSigned = [](double value) { return value < 0.5 ? value : value - 1; };
        const double now = meanStep(map.map, [](double value) { return value; }), then = meanStep(map.map, asSigned);
        if (then < 0.25 * now) {
            findings.push_back(
                {.kind = FindingKind::sign,
                 .text = fmt::format("signed numbers are stored as unsigned ones: read as signed, "
                                     "neighbouring heights differ by {:.3g} instead of {:.3g} cage units",
                                     map.cageUnits(std::abs(map.map.scale) * then),
                                     map.cageUnits(std::abs(map.map.scale) * now)),
                 .advice = "export the map as float, or as integers with one half as midlevel",
                 .figure = now / then});
            return;
        }
    }
    // Everything inwards: sculpted details usually stand out of the surface at least as much.
    if (map.used.empty()) return;
    const double one = map.heightOf(map.used.front()), other = map.heightOf(map.used.back());
    const double outwards = std::max(one, other), inwards = std::min(one, other);
    if (inwards < 0 && outwards <= 0.001 * -inwards && std::abs(outwards) < 0.02 * -inwards)
        findings.push_back(
            {.kind = FindingKind::sign,
             .isFault = false,
             .text = fmt::format("no height stands out of the surface; the deepest is {:.3g} cage units", inwards),
             .advice = fmt::format("if details should stand out: --scale {:g}", -map.cageUnits(map.map.scale)),
             .figure = inwards});
}

// --- midlevel -----------------------------------------------------------------------------------------------------

void examineMidlevel(const MapCase& map, Findings& findings) {
    // The encoding by the curve explains a midlevel, and a map of one value has none.
    const auto isColors = [](const Finding& f) { return f.kind == FindingKind::colors && f.isFault; };
    if (map.used.empty() || map.storedRange() == 0 || std::ranges::any_of(findings, isColors)) return;
    const std::vector<float>& values = map.used;
    const Peak peak = findPeak(values, peakWidth(map));
    const auto add = [&](double value, const std::string& text) {
        findings.push_back({.kind = FindingKind::midlevel,
                            .text = text,
                            .advice = fmt::format("--mid {:.6g}", value),
                            .figure = value});
    };
    // A flat part beside the midlevel in use, where few heights are at that.
    const double range = map.storedRange(), mid = map.map.mid;
    const auto countNear = [&](double value) {
        const auto from = std::ranges::lower_bound(values, float(value - peakWidth(map)));
        return double(std::ranges::upper_bound(values, float(value + peakWidth(map))) - from);
    };
    if (peak.share >= kPeakShare && std::abs(peak.value - mid) > 0.02 * range &&
        countNear(mid) < 0.2 * peak.share * double(values.size()))
        return add(peak.value,
                   fmt::format("{:.0f} % of the heights are {:.4g}, which is displaced by {:.3g} cage units; "
                               "the midlevel is {:g}",
                               100 * peak.share, peak.value, map.heightOf(peak.value), mid));
    // No height at the midlevel at all: everything moves.
    const double gap = std::max(double(values.front()) - mid, mid - double(values.back()));
    if (gap <= 0.02 * range) return;
    const double least = std::min(std::abs(map.heightOf(values.front())), std::abs(map.heightOf(values.back())));
    add(values[values.size() / 2],
        fmt::format(
            "no height is near the midlevel {:g}: stored values go from {:.4g} to {:.4g}, and all of the surface "
            "moves by {:.3g} cage units or more",
            mid, values.front(), values.back(), least));
}

} // namespace relief

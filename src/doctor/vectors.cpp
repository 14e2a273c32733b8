// What is wrong with a vector map.
#include <algorithm>
#include <cmath>

#include "doctor/examiners.h"

namespace relief {
namespace {

/// A component of the vectors where islands cover the map.
struct Component {
    std::vector<float> stored; ///< the lowest first
    double rms = 0;            ///< cage units
};

Component takeComponent(const MapCase& map, const HeightMap& channel, std::span<const std::uint32_t> coverage) {
    Component component;
    double sum = 0;
    for (std::size_t i = 0; i < coverage.size(); ++i) {
        if (coverage[i] == kNoIsland) continue;
        component.stored.push_back(channel.texels[i]);
        sum += std::pow(map.cageUnits(channel.scale * (double(channel.texels[i]) - channel.mid)), 2);
    }
    std::ranges::sort(component.stored);
    component.rms = std::sqrt(sum / double(std::max<std::size_t>(component.stored.size(), 1)));
    return component;
}

/// A flat part whose components are no displacement, but for their midlevel.
void examineMidlevelOf(const Component& component, const HeightMap& channel, const char* name, Findings& findings) {
    if (component.stored.empty()) return;
    const double range = double(component.stored.back()) - double(component.stored.front());
    const Peak peak = findPeak(component.stored, std::max(0.001 * range, 1e-7));
    if (peak.share < kPeakShare || std::abs(peak.value - channel.mid) <= std::max(0.02 * range, 0.002)) return;
    findings.push_back({.kind = FindingKind::midlevel,
                        .text = fmt::format("{:.0f} % of the {} components are {:.4g}; the midlevel is {:g}",
                                            100 * peak.share, name, peak.value, channel.mid),
                        .advice = fmt::format("--mid {:.6g}", peak.value),
                        .figure = peak.value});
}

} // namespace

void examineVectors(const MapCase& map, std::span<const std::uint32_t> coverage, Findings& findings) {
    constexpr const char* kNames[] = {"x", "y", "z"};
    const VectorMap& vectors = *map.map.vectors;
    if (map.info.sampleBytes == 1)
        findings.push_back({.kind = FindingKind::bitDepth,
                            .text = "8 bits per component",
                            .advice = "export the map again from its source with 16 bits or as float",
                            .figure = 8});
    // Each component as a map of heights: its midlevel, and how far it moves points on average.
    std::array<Component, 3> components;
    for (std::size_t k = 0; k < 3; ++k) {
        components[k] = takeComponent(map, vectors.channels[k], coverage);
        examineMidlevelOf(components[k], vectors.channels[k], kNames[k], findings);
    }

    // In tangent space details stand out along the normal; programs differ in the channel that holds it.
    constexpr double kLittle = 0.25;
    if (vectors.space != VectorSpace::tangent) return;
    const std::size_t most = components[0].rms > components[1].rms ? 0 : 1;
    const double ratio = components[most].rms > 0 ? components[2].rms / components[most].rms : 1;
    if (ratio >= kLittle) return;
    findings.push_back(
        {.kind = FindingKind::axes,
         .isFault = false,
         .text =
             fmt::format("the vectors go along {}, not along the normal: {:.3g} cage units on average against {:.3g}",
                         most == 0 ? "s" : "t", components[most].rms, components[2].rms),
         .advice = most == 1 ? "if they should stand out: --vector-preset mudbox, or another --vector-order"
                             : "if they should stand out: another --vector-order",
         .figure = ratio});
}

void examineTurns(const MapCase& map, Findings& findings) {
    double area = 0, turned = 0, lowest = 1;
    const LayoutCell* at = nullptr;
    for (const LayoutCell& cell : map.subject.layout->cells) {
        const double factor = foldFactorOf(cell, map.map, *map.subject.reference);
        area += cell.area;
        if (factor <= 0) turned += cell.area;
        if (factor < lowest) lowest = factor, at = &cell;
    }
    if (lowest > 0 || at == nullptr) return;
    findings.push_back({.kind = FindingKind::fold,
                        .isFault = false,
                        .text = fmt::format("{:.2f} % of the surface has turned over, most of all at {}",
                                            100 * turned / area, describeSpot(map, at->at)),
                        .advice = "nothing, if these are overhangs; else a lower --scale",
                        .figure = lowest,
                        .at = at->at});
}

} // namespace relief

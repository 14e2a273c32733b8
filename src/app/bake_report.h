// What `relief bake` says of a map and of the surface that it makes.
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "bake/bake.h"
#include "check/check.h"

namespace relief::app {

/// Everything that is known of a pair of a map and a sculpt, in cage units.
struct BakeReport {
    std::string cage, sculpt, map;
    Addressing addressing = Addressing::texture;
    std::size_t tileCount = 0;                          ///< of a set; of a map per face the faces
    int width = 0, height = 0;                          ///< of the largest tile
    double mid = 0, scale = 1, lowest = 0, highest = 0; ///< of the map's values; lowest and highest are heights
    std::uint64_t sculptTriangles = 0;
    bool isBaked = false; ///< else the map was there before, and nothing is known of its texels
    BakedHeights baked;   ///< counts alone
    IslandOverlap overlap;
    BakeCertificate certificate;
    SeamReport seams;
    double diagonal = 1, unit = 1; ///< of the sculpt's box, cage units; cage units per unit of the certificate
    double tolerance = 0;          ///< cage units
    double readSeconds = 0, bakeSeconds = 0, certifySeconds = 0;

    /// The larger root mean square of both directions, cage units.
    [[nodiscard]] double rms() const;
    [[nodiscard]] bool passes() const { return rms() <= tolerance; }
};

/// One line about a distance. `unit`: cage units per unit of the distance; `diagonal`: cage units.
std::string describeDistance(const char* name, const SampledDistance& distance, double unit, double diagonal);
/// Returns a sampled distance as JSON, in cage units and percent of the diagonal.
nlohmann::json distanceToJson(const SampledDistance& distance, double unit, double diagonal);

std::string toText(const BakeReport& report);
nlohmann::json toJson(const BakeReport& report);

} // namespace relief::app

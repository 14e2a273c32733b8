// What `relief check` has found, as JSON and as text.
#pragma once

#include <functional>
#include <optional>

#include <nlohmann/json.hpp>

#include "check/check.h"

namespace relief::app {

/// The triangles of one path.
struct PathReport {
    std::string path;
    Watertightness triangles;
    std::optional<std::uint64_t> crackPixels; ///< pixels that see a crack, all views; only of closed surfaces
};

/// The largest errors that are promised: of points and tangents outside end caps, as shares of the diagonal of the
/// cage's bounding box, and of normals in corners.
struct Promises {
    double point = 1e-6, tangent = 1e-5;
    double wrongShare = 0.01;  ///< of points that are displaced wrongly (SampleError::isMisplaced and isMisturned)
    double cornerDegrees = 15; ///< see CornerReport; in corners the surface itself turns by a few degrees
};

/// Maps an error to 0 at a tenth of what is promised, and up to 1 at the promise, on a logarithmic scale: rounding
/// alone stays 0. Values that are not finite are as wrong as can be.
double errorHeat(const SampleError& error);

struct Certificate {
    std::string cage, height, device; ///< height: path of the map, or empty
    std::size_t faceCount = 0;
    int isolation = 0;
    double diagonal = 0;          ///< of the cage; in the unit of `coordinates`, as all lengths
    double displacementBound = 0; ///< largest |h| of the map
    std::vector<PathReport> paths;
    std::optional<double> limitedEdgePixels; ///< length of segments, where limitEdgePixels() made them longer
    FrameErrors frames;
    CornerReport corners;
    CurvatureReport curvature;
    std::optional<SeamReport> seams; ///< with a map
    Coordinates coordinates;         ///< of all lengths and positions; both functions below print them in the world's

    /// One entry per promise that is broken: "grid: 3 open edges". Folds and seams that disagree come from the map and
    /// break none.
    [[nodiscard]] std::vector<std::string> brokenPromises() const;
};

inline constexpr std::uint64_t kMostCheckedTriangles = 2'000'000; ///< most cages have half as many

/// Returns the length of segments, in pixels, with which at most kMostCheckedTriangles are made: `pixels`, doubled as
/// often as that needs, until it is `most` or more. `planned`: the triangles that a length makes.
double limitEdgePixels(double pixels, double most, const std::function<std::uint64_t(double)>& planned);

nlohmann::json toJson(const Certificate& certificate);
std::string toText(const Certificate& certificate);

} // namespace relief::app

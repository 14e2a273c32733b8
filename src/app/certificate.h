// What `relief check` has found out, as JSON and as words.
#pragma once

#include <optional>

#include <nlohmann/json.hpp>

#include "check/check.h"

namespace relief::app {

/// The triangles of one path.
struct PathReport {
    std::string path;
    Watertightness triangles;
    std::optional<std::uint64_t> crackPixels; ///< over all views; only of surfaces that enclose a volume
};

/// What is promised of frames outside end caps, over the diagonal of the cage's bounding box, and of normals in
/// corners.
struct Promises {
    double point = 1e-6, tangent = 1e-5;
    double wrongShare = 0.01;  ///< of points that are displaced wrongly (SampleError::isMisplaced and isMisturned)
    double cornerDegrees = 15; ///< see CornerReport; in corners the surface itself turns by a few degrees
};
Promises promisesAt(int isolation);

struct Certificate {
    std::string cage, height, device; ///< height: "" without a map
    std::size_t faceCount = 0;
    int isolation = 0;
    double diagonal = 0, reach = 0; ///< in `coordinates`, as all lengths; largest height of the map
    std::vector<PathReport> paths;
    FrameErrors frames;
    CornerReport corners;
    CurvatureReport curvature;
    std::optional<SeamReport> seams; ///< with a map
    Coordinates coordinates;         ///< what is printed is in the world

    /// One entry for each promise that is broken: "grid: 3 open edges". Folds and seams are the map's, not ours.
    [[nodiscard]] std::vector<std::string> brokenPromises() const;
};

nlohmann::json toJson(const Certificate& certificate);
std::string toText(const Certificate& certificate);

} // namespace relief::app

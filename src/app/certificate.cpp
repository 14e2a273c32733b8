#include "app/certificate.h"

#include <algorithm>
#include <cmath>

namespace relief::app {
namespace {

using nlohmann::json;

void addBroken(std::vector<std::string>& broken, const PathReport& report) {
    const Watertightness& w = report.triangles;
    const auto add = [&](std::uint64_t count, const char* what) {
        if (count > 0) broken.push_back(fmt::format("{}: {} {}", report.path, count, what));
    };
    add(w.openEdges, "open edges");
    add(w.tJunctions, "T-junctions");
    add(w.notFinite, "vertices that are not finite");
    if (!w.hasAllTriangles())
        broken.push_back(fmt::format("{}: {} triangles instead of {}", report.path, w.triangles, *w.expectedTriangles));
    if (!w.isBoundaryWhole())
        broken.push_back(fmt::format("{}: {} segments on the cage's boundary instead of {}", report.path,
                                     w.boundarySegments, w.expectedBoundarySegments));
    add(report.crackPixels.value_or(0), "pixels see a crack");
}

// --- JSON

json makeLocationJson(const SurfaceLocation& location) {
    return {{"face", location.face}, {"u", location.uv.x}, {"v", location.uv.y}};
}

json makePathJson(const PathReport& report, const Coordinates& coordinates) {
    const Watertightness& w = report.triangles;
    const dvec3 worst = coordinates.toWorld(w.worstLocation);
    return {{"path", report.path},
            {"watertight", w.isWatertight() && report.crackPixels.value_or(0) == 0},
            {"triangles", w.triangles},
            {"expected_triangles", w.expectedTriangles ? json(*w.expectedTriangles) : json()},
            {"distinct_points", w.distinctPoints},
            {"degenerate_triangles", w.degenerateTriangles},
            {"open_edges", w.openEdges},
            {"t_junctions", w.tJunctions},
            {"not_finite", w.notFinite},
            {"boundary_segments", w.boundarySegments},
            {"expected_boundary_segments", w.expectedBoundarySegments},
            {"largest_gap_ulps", w.largestGapUlps},
            {"largest_gap_at", {worst.x, worst.y, worst.z}},
            {"crack_pixels", report.crackPixels ? json(*report.crackPixels) : json()}};
}

json makeErrorJson(const ErrorSummary& error) {
    return {{"max", error.max}, {"rms", error.rms}, {"max_at", makeLocationJson(error.worst)}};
}

json makeRegionJson(const RegionErrors& errors) {
    return {{"points", errors.count},
            {"points_without_normal", errors.countWithoutNormal},
            {"misplaced_points", errors.countMisplaced},
            {"misturned_normals", errors.countMisturned},
            {"point", makeErrorJson(errors.point)},
            {"tangents", makeErrorJson(errors.tangent)},
            {"limit_normal_degrees", makeErrorJson(errors.limitNormal)},
            {"displaced_normal_degrees", makeErrorJson(errors.normal)}};
}

json makeCornersJson(const CornerReport& corners) {
    return {{"count", corners.count},
            {"normal_turn_max_degrees", corners.max},
            {"max_at", makeLocationJson(corners.worst)}};
}

json makeCurvatureJson(const CurvatureReport& report) {
    return {{"points", report.count},
            {"points_without_curvature", report.countWithoutCurvature},
            {"min_one_plus_h_kappa", report.lowestFactor},
            {"min_at", makeLocationJson(report.lowestAt)},
            {"area", report.area},
            {"folded_area", report.foldedArea},
            {"folded_fraction", report.foldedFraction()},
            {"first_order_normal_max_degrees", report.maxNormalAngle},
            {"first_order_normal_max_at", makeLocationJson(report.maxNormalAngleAt)},
            {"first_order_normal_mean_degrees", report.meanNormalAngle}};
}

json makeSeamsJson(const SeamReport& seams, double displacementBound) {
    return {{"edges", seams.seamEdgeCount},
            {"length", seams.length},
            {"disagreement_max", seams.max},
            {"disagreement_mean", seams.mean},
            {"max_of_displacement_bound", displacementBound > 0 ? seams.max / displacementBound : 0},
            {"max_at", makeLocationJson(seams.worst)}};
}

// --- text

std::string describe(const SurfaceLocation& location) {
    return fmt::format("face {} ({:.4g}, {:.4g})", location.face, location.uv.x, location.uv.y);
}

std::string makePathTable(const Certificate& c) {
    std::string text = fmt::format("  {:14}{:>12}{:>12}{:>13}{:>11}{:>14}{:>15}\n", "path", "triangles", "open edges",
                                   "T-junctions", "gap (ulp)", "crack pixels", "boundary");
    for (const PathReport& report : c.paths) {
        const Watertightness& w = report.triangles;
        text += fmt::format("  {:14}{:>12}{:>12}{:>13}{:>11.4g}{:>14}{:>15}\n", report.path, w.triangles, w.openEdges,
                            w.tJunctions, w.largestGapUlps,
                            report.crackPixels ? fmt::format("{}", *report.crackPixels) : "-",
                            fmt::format("{} of {}", w.boundarySegments, w.expectedBoundarySegments));
    }
    return text;
}

std::string makeRegionTable(const char* title, const RegionErrors& errors) {
    if (errors.count == 0) return "";
    std::string text = fmt::format("  {:28}{:>11}{:>11}   worst at\n",
                                   fmt::format("{}, {} points", title, errors.count), "max", "rms");
    const auto row = [&](const char* name, const ErrorSummary& error) {
        text += fmt::format("    {:26}{:>11.2e}{:>11.2e}   {}\n", name, error.max, error.rms, describe(error.worst));
    };
    row("points / diagonal", errors.point);
    row("tangents / diagonal", errors.tangent);
    row("limit normals, degrees", errors.limitNormal);
    row("displaced normals, degrees", errors.normal);
    return text;
}

std::string makeCornerText(const CornerReport& corners) {
    return fmt::format("  normals in {} corners turn by up to {:.3g} degrees more than those beside them, at {}\n",
                       corners.count, corners.max, describe(corners.worst));
}

std::string makeCurvatureText(const CurvatureReport& r) {
    std::string text = fmt::format("  least 1 + h kappa is {:.4g}, at {}\n", r.lowestFactor, describe(r.lowestAt));
    if (r.foldedArea > 0)
        text += fmt::format("  The map folds the surface over itself on {:.3g} % of its area: heights exceed "
                            "the radius of curvature there. Lower --scale, or smooth the cage.\n",
                            100 * r.foldedFraction());
    else
        text += "  No folds: the displaced surface is locally one-to-one.\n";
    return text + fmt::format("  Normals without the curvature term would be off by up to {:.3g} degrees, {:.3g} on "
                              "average.\n",
                              r.maxNormalAngle, r.meanNormalAngle);
}

/// Heights that differ by less than this share of the displacement bound count as equal: float maps are rounded.
constexpr double kSameHeight = 1e-7;

std::string makeSeamText(const SeamReport& seams, double displacementBound) {
    if (seams.seamEdgeCount == 0) return "  The map has no seams on this cage.\n";
    if (seams.max <= kSameHeight * displacementBound)
        return fmt::format("  The two sides of {} seam edges have equal heights.\n", seams.seamEdgeCount);
    return fmt::format("  The two sides of {} seam edges disagree by up to {:.3g} cage units ({:.3g} % of the "
                       "displacement bound), {:.3g} on average, most at {}; both sides are drawn with the heights of "
                       "the edge's owner face.\n",
                       seams.seamEdgeCount, seams.max, displacementBound > 0 ? 100 * seams.max / displacementBound : 0,
                       seams.mean, describe(seams.worst));
}

} // namespace

double errorHeat(const SampleError& error) {
    const Promises promises;
    constexpr double kDecades = 1;
    const double share = std::max(error.point / promises.point, error.tangent / promises.tangent);
    if (!std::isfinite(error.point + error.tangent)) return 1;
    return std::clamp(1 + std::log10(share) / kDecades, 0.0, 1.0);
}

std::vector<std::string> Certificate::brokenPromises() const {
    std::vector<std::string> broken;
    for (const PathReport& report : paths) addBroken(broken, report);
    const Promises promises;
    const auto check = [&](const ErrorSummary& error, double most, const char* what) {
        if (error.max > most)
            broken.push_back(fmt::format("{} are off by {:.2e} of the diagonal at {}, more than {:.0e}", what,
                                         error.max, describe(error.worst), most));
    };
    check(frames.regular.point, promises.point, "points");
    check(frames.regular.tangent, promises.tangent, "tangents");
    const RegionErrors& regular = frames.regular;
    const auto checkShare = [&](std::uint64_t count, const char* what) {
        if (double(count) > promises.wrongShare * double(regular.count - regular.countWithoutNormal))
            broken.push_back(fmt::format("{} of {} {}", count, regular.count - regular.countWithoutNormal, what));
    };
    checkShare(regular.countMisplaced, "displaced points are not p + h n");
    checkShare(regular.countMisturned, "displaced normals are off by more than 0.1 degrees");
    if (corners.max > promises.cornerDegrees)
        broken.push_back(fmt::format("the normal at {} is off by {:.3g} degrees from those beside it, more than {}",
                                     describe(corners.worst), corners.max, promises.cornerDegrees));
    return broken;
}

namespace {

/// The certificate with lengths and areas in the world's units.
Certificate inWorldUnits(Certificate c) {
    const double unit = c.coordinates.unit;
    c.diagonal *= unit, c.displacementBound *= unit;
    c.curvature.area *= unit * unit, c.curvature.foldedArea *= unit * unit;
    if (c.seams) c.seams->length *= unit, c.seams->max *= unit, c.seams->mean *= unit;
    return c;
}

} // namespace

json toJson(const Certificate& local) {
    const Certificate c = inWorldUnits(local);
    json all{
        {"cage", c.cage},
        {"device", c.device},
        {"faces", c.faceCount},
        {"isolation", c.isolation},
        {"diagonal", c.diagonal},
        {"paths", json::array()},
        {"frames", {{"regular", makeRegionJson(c.frames.regular)}, {"end_caps", makeRegionJson(c.frames.endCaps)}}},
        {"corners", makeCornersJson(c.corners)},
        {"curvature", makeCurvatureJson(c.curvature)},
        {"broken_promises", c.brokenPromises()}};
    for (const PathReport& report : c.paths) all["paths"].push_back(makePathJson(report, c.coordinates));
    if (c.limitedEdgePixels) all["limited_edge_pixels"] = *c.limitedEdgePixels;
    if (!c.height.empty()) all["height"] = c.height, all["displacement_bound"] = c.displacementBound;
    if (c.seams) all["seams"] = makeSeamsJson(*c.seams, c.displacementBound);
    return all;
}

double limitEdgePixels(double pixels, double most, const std::function<std::uint64_t(double)>& planned) {
    while (planned(pixels) > kMostCheckedTriangles && pixels < most) pixels *= 2;
    return pixels;
}

std::string toText(const Certificate& local) {
    const Certificate c = inWorldUnits(local);
    std::string text = fmt::format("{}{} on {}\n", c.cage, c.height.empty() ? "" : " with " + c.height, c.device);
    text += "watertight\n" + makePathTable(c);
    text += "exact, against a double-precision reference\n" +
            makeRegionTable(c.frames.endCaps.count > 0 ? "outside end caps" : "everywhere", c.frames.regular) +
            makeRegionTable("in end caps", c.frames.endCaps) + makeCornerText(c.corners);
    if (!c.height.empty()) text += "one-to-one\n" + makeCurvatureText(c.curvature);
    if (c.seams) text += "seams\n" + makeSeamText(*c.seams, c.displacementBound);
    return text;
}

} // namespace relief::app

// What suites find: metrics and methods with their names, rows of values, comparison of two results, goals, and the
// forms in which results are written and read.
#pragma once

#include <limits>
#include <map>
#include <span>

#include "base/base.h"

namespace relief {

// --- words: each enumeration has one table of names in words.cpp ---------------------------------------------------

enum class Unit { number, milliseconds, microseconds, nanoseconds, bytes, ratio, diagonal, white, decibels };

/// What a value is. describe() has its name, its unit and what it means.
// clang-format off
enum class Metric {
    // Times of one frame.
    frameTime, trianglePassTime, ratePassTime, dicePassTime, colorPassTime, lightPassTime, poseTime,
    // Counts of one frame.
    triangles, distinctVertices, vertexInvocations, tessellationInvocations, primitives, clippedPrimitives,
    fragmentInvocations,
    // Bytes.
    residentBytes, diskBytes, bytesReadCached, bytesReadUncached, uploadedBytes,
    // Errors, and the compression that meets a tolerance.
    rmsError, hausdorffError, pictureRmse, picturePsnr, mapColumns, rate, isolation, positionBits, imageColumns,
    mapFileExrZip, mapFileExrPiz, mapFilePng, mapFileBlocks,
    // Costs per triangle and per face.
    costPerTriangle, costPerAdditionalTriangle, tableTime, uploadTime, preparationPerFace,
    // Memory of a process.
    surfaceAndMapBytes, bufferBytes, bufferBytesAtRate1, processBytes, processBytesAtRate1, memoryPerBufferByte,
    // Starting up.
    coldRunTime, warmRunTime, deviceOpenTime, warmFrameTime, coldRunPerFrame,
    // Against displacement whose segments are a quarter as long.
    errorPerFinerError, timePerFinerTime,
    // Passes of light besides the key light's own.
    shadowPassTime, occlusionPassTime, otherLightsTime
};
// clang-format on
struct MetricInfo {
    Metric metric;
    const char* name; ///< as files and tables spell it
    Unit unit;
    const char* meaning; ///< one sentence
};
const MetricInfo& describe(Metric metric);

/// How a surface is stored or drawn, or what else a row is about.
// clang-format off
enum class Method {
    cageFloatMap, cageHalfMap, cageUnorm16Map, cageUnorm8Map, cageBc4Map,
    denseRaw, denseQuantised, denseDraco, simplifiedRaw, simplifiedQuantised, simplifiedDraco,
    geometryImage,
    tessellation, grid, dicing, dicingInCompute, denseInCompute,
    posedCage, posedCageTessellation, posedCageDicing, denseSkinnedOnDevice, densePosedOnHost,
    preparation, reliefRender,
    displacement, displacementAndBump, bump, undisplaced,
    keyLight, keyLightWithShadows, keyLightWithOcclusion, threeLights, metal, phong, phongTable, matcap, water
};
// clang-format on
enum class Suite { bandwidth, frame, animate, memory, scaling, startup, detail, light };
/// What a suite varies. `pixelTriangles` are triangles in a picture that has one pixel for each, `segmentPixels` the
/// length of segments on screen.
enum class Axis { none, tolerance, triangles, pixelTriangles, faces, segmentPixels };
/// Whether a value was measured (also by counting or writing a file) or computed from measured values.
enum class Origin { measured, computed };

const char* toWord(Unit unit);
const char* toWord(Method method);
const char* toWord(Suite suite);
const char* toWord(Axis axis);
const char* toWord(Origin origin);
std::span<const Suite> allSuites();
/// Throws Failure::input where no suite has this name.
Suite parseSuite(const std::string& word);

// --- results -------------------------------------------------------------------------------------------------------

/// The median and the 5th and 95th percentiles.
struct Spread {
    double median = 0, p5 = 0, p95 = 0;
};
/// Interpolates linearly between neighbouring samples. All 0 without samples.
Spread computeSpread(std::vector<double> samples);

/// One quantity with all its samples, in the unit of its metric.
struct Value {
    Metric metric;
    Origin origin = Origin::measured;
    std::vector<double> samples;

    [[nodiscard]] double median() const { return computeSpread(samples).median; }
};

/// What was found of one method in one scene at one point of the axis of a suite.
struct Row {
    Suite suite = Suite::frame;
    std::string scene; ///< the name of a TestScene
    Method method = Method::grid;
    Axis axis = Axis::none;
    double at = 0; ///< tolerance: RMS distance as a fraction of the diagonal; else a count; 0 without an axis
    std::vector<Value> values;

    /// Null where the row has no such value.
    [[nodiscard]] const Value* find(Metric metric) const;
    /// The median, or `otherwise`.
    [[nodiscard]] double get(Metric metric, double otherwise = 0) const;
    void addMeasured(Metric metric, double sample);
    void addMeasured(Metric metric, std::vector<double> samples);
    void addComputed(Metric metric, double sample);
};

/// Two pictures of the same view and their difference, as PNG files in memory.
struct PicturePair {
    std::string scene, title, left, right; ///< captions
    std::string leftPng, rightPng, differencePng;
};

/// Everything that suites found.
struct Results {
    std::map<std::string, std::string> program, machine, device, settings;
    std::vector<Row> rows;
    std::vector<std::string> notes;    ///< what is missing, and why
    std::vector<PicturePair> pictures; ///< only in the report, not in JSON
};

// --- comparison of two results -------------------------------------------------------------------------------------

/// A time or a number of bytes in two results.
struct Change {
    Suite suite = Suite::frame;
    std::string scene;
    Method method = Method::grid;
    Axis axis = Axis::none;
    Metric metric = Metric::frameTime;
    double at = 0, before = 0, after = 0;
    double ratio = 1;          ///< of the medians, after / before
    double low = 1, high = 1;  ///< the ratios of opposite 5th and 95th percentiles
    bool isRegression = false; ///< the ratio is above 1 + tolerance, and low > 1: the spreads do not explain it
};
struct Comparison {
    std::vector<Change> changes;
    std::vector<std::string> onlyInOne; ///< rows that only one of the results has
    std::vector<std::string> warnings;  ///< different machines or settings

    [[nodiscard]] bool hasRegression() const;
};
/// Compares times and bytes of two results. `tolerance`: the growth that is no regression, as a fraction.
Comparison compareResults(const Results& before, const Results& after, double tolerance);

// --- goals ---------------------------------------------------------------------------------------------------------

/// Which value of the selected rows counts: where Row::at is smallest, where it is largest, or (max - min) /
/// (max + min) of all of them, the largest deviation from the middle of the range.
enum class Statistic { atSmallest, atLargest, deviation };

/// The rows that a goal is about.
struct GoalSubject {
    Suite suite = Suite::frame;
    Axis axis = Axis::none;
    double from = 0, to = std::numeric_limits<double>::infinity(); ///< bounds of Row::at, inclusive
    std::vector<Method> methods;                                   ///< the smallest value among these counts
    std::vector<Method> dividedBy; ///< it is divided by the smallest among these; none: not divided
    Statistic statistic = Statistic::atSmallest;
};
/// A figure to reach, as bench/goals.json has those of the project.
struct Goal {
    std::string name; ///< one line for the report
    Metric metric = Metric::frameTime;
    GoalSubject subject;
    bool isAtLeast = true; ///< else at most
    double value = 0;
    std::string reason; ///< why it is hard to reach: reported where it is missed
};
struct GoalResult {
    Goal goal;
    std::string scene;
    double found = 0;

    [[nodiscard]] bool isMet() const { return goal.isAtLeast ? found >= goal.value : found <= goal.value; }
};
/// Reads {"schema": "relief-goals", "version": 1, "goals": [...]}: see goals.cpp for the shape. Throws Failure::input,
/// naming `name` and the goal, for any other text.
std::vector<Goal> parseGoals(const std::string& text, const std::string& name);
/// One result for each goal and scene whose rows are there, in the order of the goals.
std::vector<GoalResult> evaluateGoals(std::span<const Goal> goals, const Results& results);

// --- forms of results ----------------------------------------------------------------------------------------------

/// Writes results as JSON: {"schema": "relief-bench", "version": 2, ...}, see json.cpp for the shape. Pictures are not
/// in it.
std::string toJson(const Results& results);
/// Reads what toJson() has written. Throws Failure::input, naming `name`, for text of another shape or version.
Results parseResults(const std::string& text, const std::string& name);
/// Writes results as CSV, one line per value: suite, scene, method, axis, at, metric, unit, origin, number of samples,
/// median, p5, p95.
std::string toCsv(const Results& results);
/// Writes results as text for a terminal: one table per suite, scene and axis, then the goals.
std::string toTable(const Results& results, std::span<const Goal> goals = {});
/// Makes one HTML page that loads nothing else: goals, plots, tables, pictures, and the assumptions of the model of
/// bytes.
std::string makeReport(const Results& results, std::span<const Goal> goals = {});

} // namespace relief

// What displacement costs and saves, against dense meshes of the same error: suites, opponents, results, a report.
#pragma once

#include <map>
#include <optional>
#include <span>

#include "distance/distance.h"
#include "frame/frame.h"

namespace relief {

// --- results ------------------------------------------------------------------------------------------------------

/// Of samples that run from the fastest to the slowest: linear between neighbours.
struct Spread {
    double median = 0, p5 = 0, p95 = 0;
};
Spread spreadOf(std::vector<double> samples);

/// Whether something was drawn or written and looked at, or follows by arithmetic from what was.
enum class Origin { measured, computed };

/// One quantity with every sample of it; units: "ms", "bytes", "triangles", ...
struct Value {
    std::string name, unit;
    Origin origin = Origin::measured;
    std::vector<double> samples;

    [[nodiscard]] double median() const { return spreadOf(samples).median; }
};

/// One contestant at one place of the axis that its suite walks along.
struct Row {
    std::string suite, scene, contestant;
    std::string axis; ///< "tolerance", "triangles", "faces", or "" where there is one place
    double at = 0;
    std::vector<Value> values;

    /// Null where there is no such value.
    [[nodiscard]] const Value* find(const std::string& name) const;
    /// The median, or `otherwise`.
    [[nodiscard]] double get(const std::string& name, double otherwise = 0) const;
    void add(const std::string& name, const std::string& unit, Origin origin, double sample);
    void add(const std::string& name, const std::string& unit, std::vector<double> samples); ///< measured
};

/// Two pictures of the same view and what differs, as PNG files in memory.
struct PicturePair {
    std::string scene, title, left, right; ///< words
    std::string leftPng, rightPng, differencePng;
};

/// Everything that a run tells.
struct Results {
    std::map<std::string, std::string> program, machine, device, settings;
    std::vector<Row> rows;
    std::vector<std::string> notes;    ///< what was left out, and why
    std::vector<PicturePair> pictures; ///< in the report alone
};

/// "relief-bench", version 1: see jsonOf() for the shape.
std::string jsonOf(const Results& results);
/// Throws Failure::input, naming `name`, for text of another shape or version. There are no pictures in it.
Results parseResults(const std::string& text, const std::string& name);
/// One line a value: suite, scene, contestant, axis, at, value, unit, origin, samples, median, p5, p95.
std::string csvOf(const Results& results);
/// For people: a table a suite.
std::string tableOf(const Results& results);
/// One HTML page that needs nothing else: plots, tables, pictures, and the model of bytes in words.
std::string reportOf(const Results& results);

/// A time or a number of bytes in two runs. Ratios are second to first; `low` and `high` span the 5th and 95th
/// percentiles of both.
struct Change {
    std::string suite, scene, contestant, axis, name, unit;
    double at = 0, before = 0, after = 0;
    double ratio = 1, low = 1, high = 1;
    bool isRegression = false; ///< the ratio is past the tolerance, and the spreads do not explain it: low > 1
};
struct Comparison {
    std::vector<Change> changes;
    std::vector<std::string> onlyInOne; ///< rows without a partner
    std::vector<std::string> warnings;  ///< other machines, other settings

    [[nodiscard]] bool hasRegression() const;
};
Comparison compareResults(const Results& before, const Results& after, double tolerance);

// --- the model of bytes -------------------------------------------------------------------------------------------

/// The same map in other texels, 32-bit floats: those whose lookups come nearest, by least squares.
HeightMap resampled(const HeightMap& map, int width, int height);

/// How a dense mesh is kept on the device.
struct DenseLayout {
    std::uint32_t positionBytes, normalBytes, texCoordBytes, indexBytes;

    [[nodiscard]] std::uint32_t vertexBytes() const { return positionBytes + normalBytes + texCoordBytes; }
};
inline constexpr DenseLayout kRawLayout{12, 12, 8, 4};
/// 16-bit positions, 8-bit octahedral normals in what pads them to four numbers, 16-bit texture coordinates.
inline constexpr DenseLayout kQuantisedLayout{6, 2, 4, 4};

struct MeshCounts {
    std::uint64_t vertices = 0, triangles = 0;
};
std::uint64_t residentBytes(const DenseLayout& layout, const MeshCounts& counts);

/// What a frame reads (and writes, where triangles go through memory) to make its triangles: between every resident
/// byte once, with caches that hold everything, and every fetch of every call, without caches.
struct Traffic {
    std::uint64_t least = 0, cacheless = 0;
};
/// `vertexCalls`: of the vertex shader.
Traffic denseTraffic(const DenseLayout& layout, const MeshCounts& counts, std::uint64_t vertexCalls);

/// What one evaluation of a bicubic patch with its height reads.
struct Evaluation {
    bool hasTexCoords = true;
    bool hasWideIndices = false; ///< as Model
    MapFormat format = MapFormat::real;
};
/// Records, tree, 16 points with their numbers, 12 texels of the map: a word each, of BC4 two.
std::uint64_t evaluationBytes(const Evaluation& evaluation);

struct SurfaceTrafficDesc {
    std::uint64_t residentBytes = 0;
    std::uint64_t calls = 0; ///< evaluations of the surface
    Evaluation evaluation;
    MeshCounts diced; ///< dicing: the mesh that is written and read again, or none
};
Traffic surfaceTraffic(const SurfaceTrafficDesc& desc);

/// Sent to the device for one pose: the cage's points, three floats each, or what moves of a dense mesh.
std::uint64_t posedCageBytes(std::uint64_t cagePoints);
std::uint64_t posedDenseBytes(const DenseLayout& layout, std::uint64_t vertices);

// --- opponents ----------------------------------------------------------------------------------------------------

/// A mesh in another form: its bytes, and what is left of its geometry.
struct EncodedMesh {
    DenseMesh decoded;
    std::uint64_t residentBytes = 0, diskBytes = 0; ///< 0 where the form is not for that
};

/// In kQuantisedLayout, triangles and vertices in the order that caches like; on disk run through meshoptimizer's
/// encoders.
EncodedMesh quantised(const DenseMesh& mesh);
/// About so many triangles, by meshoptimizer's simplifier.
DenseMesh simplified(const DenseMesh& mesh, std::size_t triangles);
/// As Draco's edgebreaker keeps it, with so many bits a coordinate; normals 8 bits, texture coordinates 12.
EncodedMesh dracoEncoded(const DenseMesh& mesh, int positionBits);

// --- suites -------------------------------------------------------------------------------------------------------

/// A cage with its map.
struct Subject {
    std::string name;
    Cage cage;
    SurfaceOptions surface;
    HeightMap height;           ///< as the device reads it
    MapEncoding heightEncoding; ///< how the device stores it
};

/// Smooth noise and a crisp pattern on bigguy (in the folder RELIEF_DATA, where it is there) or the project's octopus.
std::vector<Subject> builtInSubjects(bool isQuick);

struct MeasureOptions {
    bool isQuick = false;
    std::string device;  ///< as DeviceDesc::name
    std::string program; ///< relief itself, which `startup` runs
    ShowProgress progress = ShowProgress::automatic;
};

/// "bandwidth", "frame", "animate", "memory", "scaling", "startup".
const std::vector<std::string>& suiteNames();
/// Runs the named suites, in the order above.
Results runSuites(std::span<const std::string> suites, std::span<const Subject> subjects,
                  const MeasureOptions& options);

} // namespace relief

// The suite `bandwidth`: bytes at equal error. For each tolerance every method is made as small as it can be with an
// RMS distance to the reference surface within the tolerance. Searches predict; everything that is reported was
// measured.
#include <algorithm>
#include <cmath>

#include "measure/compression.h"
#include "measure/geometry_images.h"
#include "measure/pictures.h"

namespace relief {
namespace {

/// A method, and the format of its map.
struct FormatMethod {
    MapFormat format;
    Method method;
};
constexpr FormatMethod kFormatMethods[] = {{MapFormat::real, Method::cageFloatMap},
                                           {MapFormat::half, Method::cageHalfMap},
                                           {MapFormat::unorm16, Method::cageUnorm16Map},
                                           {MapFormat::unorm8, Method::cageUnorm8Map},
                                           {MapFormat::bc4, Method::cageBc4Map}};

/// The forms of one mesh: as it is, quantised, and by Draco.
struct MeshMethods {
    Method raw, quantised, draco;
};
constexpr MeshMethods kDenseMethods{Method::denseRaw, Method::denseQuantised, Method::denseDraco};
constexpr MeshMethods kSimplifiedMethods{Method::simplifiedRaw, Method::simplifiedQuantised, Method::simplifiedDraco};

constexpr int kMaxFailures = 2; ///< maps of one size that are predicted to meet a tolerance and do not
constexpr int kRateTries = 2;   ///< rates that are measured for one compression
constexpr double kSlack = 1.02; ///< of the tolerance, for encoded meshes: the mesh itself may just meet it

/// What was found of a method at one tolerance.
struct Entry {
    Method method;
    MeshError error;
    std::uint64_t triangles = 0;
    double diskBytes = 0, residentBytes = 0, uploadedBytes = 0; ///< 0 where the method is not used for that
    Traffic traffic;
    std::optional<Compression> compression; ///< what is drawn: this,
    std::optional<DenseMesh> mesh;          ///< or this
    bool isTimed = false;
    std::vector<Value> details;
};

double square(double x) { return x * x; }
Value makeDetail(Metric metric, double value) { return {metric, Origin::measured, {value}}; }

MeshCounts countMesh(const DenseMesh& mesh) { return {mesh.positions.size(), mesh.indices.size() / 3}; }

class BandwidthSuite {
public:
    BandwidthSuite(SuiteContext& context, const TestScene& scene)
        : context_(context), study_(context.device, scene, context.options.isQuick ? 6e4 : 1e6,
                                    context.options.isQuick ? 40'000 : 100'000),
          images_(study_, context.options.isQuick ? 150e3 : 250e3, context.options.isQuick ? 513 : 2049),
          pictures_(context, study_), cageFileBytes_(double(measureCageFile(scene.cage))) {}

    void run() {
        const std::vector<double> tolerances = chooseTolerances();
        makeSimplified(tolerances.back());
        if (!images_.complaint().empty()) context_.results.notes.push_back("bandwidth: " + images_.complaint());
        for (const double tolerance : tolerances) {
            std::vector<Entry> entries;
            for (const FormatMethod& method : kFormatMethods) addSurface(entries, tolerance, method);
            addDense(entries, tolerance);
            addSimplified(entries, tolerance);
            if (images_.complaint().empty()) addImage(entries, tolerance);
            pictures_.compare(tolerance, listPictures(entries, tolerance == tolerances.front()));
            for (const Entry& entry : entries) addRow(entry, tolerance);
            context_.progress.advance();
        }
    }

private:
    /// The error of the dense mesh of a million triangles, rounded up to two digits; and round numbers above it that
    /// are below the heights themselves.
    std::vector<double> chooseTolerances() {
        const double dense = computeErrorAtRate(study_.referenceRate() / 2);
        const double unit = std::pow(10, std::floor(std::log10(dense)) - 1);
        std::vector<double> all{std::ceil(dense / unit) * unit};
        const double most = 0.5 * study_.computeHeightDeviation();
        for (const double round : {1e-5, 2e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3})
            if (round > 1.99 * all.back() && round < most && all.size() < (context_.options.isQuick ? 1u : 3u))
                all.push_back(round);
        return all;
    }

    double computeErrorAtRate(int rate) {
        Compression compression = study_.uncompressed();
        compression.rate = rate;
        return study_.evaluate(compression).error.rms;
    }

    /// The smallest rate that meets the tolerance with nothing else compressed; 0 where none does.
    int findSmallestRate(double tolerance) {
        int low = 0, high = study_.largestRate();
        if (computeErrorAtRate(high) > tolerance) return 0;
        while (high - low > 1) {
            const int middle = (low + high) / 2;
            (computeErrorAtRate(middle) <= tolerance ? high : low) = middle;
        }
        return high;
    }

    /// What a compression adds to the square of the error. Errors of different causes are nearly independent, so that
    /// their squares add up.
    double computeExcess(const Compression& compression) {
        return std::max(0.0, square(study_.evaluate(compression).error.rms) -
                                 square(study_.evaluate(study_.uncompressed()).error.rms));
    }

    double computeResidentBytes(const Compression& c) {
        return double(study_.surfaceBytes(c.isolation) +
                      mapBytes(c.format, c.mapColumns, study_.computeMapRows(c.mapColumns)));
    }

    /// The square of the error without that of the rate, predicted as the sum over the parts of the compression.
    double predictSquaredError(const Compression& compression) {
        Compression isolation = study_.uncompressed(), size = study_.uncompressed();
        isolation.isolation = compression.isolation;
        size.mapColumns = compression.mapColumns;
        return computeExcess(isolation) + computeExcess(size) +
               square(study_.computeFormatError(compression.mapColumns, compression.format));
    }

    /// The compressions that are predicted to meet the tolerance at some rate, fewest bytes first.
    std::vector<Compression> listPromising(double tolerance, MapFormat format) {
        std::vector<Compression> all;
        const std::vector<int> sizes = study_.listMapColumns();
        // Deepest isolation first: where the largest map is beyond the tolerance, a lower isolation is, too.
        for (const int isolation : {6, 4, 3, 2, 1, 0}) {
            if (isolation > study_.scene().surface.isolation) continue;
            Compression compression{isolation, study_.uncompressed().mapColumns, format, study_.largestRate()};
            // Errors fall as maps grow: the smallest map that is not beyond the tolerance is found by halving.
            const auto isBeyond = [&](int columns) {
                compression.mapColumns = columns;
                return predictSquaredError(compression) > square(tolerance);
            };
            const auto first = std::ranges::partition_point(sizes, isBeyond);
            if (first == sizes.end()) break;
            for (const int columns : std::span(first, sizes.end()))
                compression.mapColumns = columns, all.push_back(compression);
        }
        std::ranges::sort(all, {}, [&](const Compression& c) { return computeResidentBytes(c); });
        return all;
    }

    /// The smallest rate with which a compression meets the tolerance, predicted and then measured; 0 where none does.
    int findRate(Compression compression, double tolerance) {
        const double left = square(tolerance) - predictSquaredError(compression);
        int rate = left > 0 ? findSmallestRate(std::sqrt(left)) : 0;
        for (int tries = 0; tries < kRateTries; ++tries) {
            compression.rate = rate == 0 ? study_.largestRate() : rate;
            if (study_.evaluate(compression).error.rms <= tolerance) return compression.rate;
            if (compression.rate == study_.largestRate()) return 0;
            rate = std::min(study_.largestRate(), rate + std::max(1, rate / 4));
        }
        return 0;
    }

    void addSurface(std::vector<Entry>& entries, double tolerance, const FormatMethod& method) {
        std::map<int, int> failures; // by columns of the map
        for (Compression& compression : listPromising(tolerance, method.format)) {
            if (failures[compression.mapColumns] == kMaxFailures) continue;
            compression.rate = findRate(compression, tolerance);
            if (compression.rate == 0) {
                ++failures[compression.mapColumns];
                continue;
            }
            entries.push_back(makeSurfaceEntry(method.method, compression));
            return;
        }
        addNote(toWord(method.method), tolerance);
    }

    Entry makeSurfaceEntry(Method method, const Compression& compression) {
        const Evaluated& evaluated = study_.evaluate(compression);
        Entry entry{.method = method, .error = evaluated.error, .triangles = evaluated.counts.triangles};
        entry.residentBytes = double(evaluated.residentBytes);
        entry.uploadedBytes = double(computePosedCageBytes(study_.scene().cage.positions.size()));
        entry.traffic = computeSurfaceTraffic({.residentBytes = evaluated.residentBytes,
                                               .evaluationCount = evaluated.counts.vertices,
                                               .evaluation = evaluated.evaluation,
                                               .diced = {}});
        entry.compression = compression;
        entry.isTimed = true;
        entry.details = {makeDetail(Metric::mapColumns, compression.mapColumns),
                         makeDetail(Metric::rate, compression.rate),
                         makeDetail(Metric::isolation, compression.isolation)};
        // On disk the smallest of the map's files counts.
        const HeightMap& map = study_.map(compression.mapColumns, compression.format).decoded;
        for (const MapFile& file : measureMapFiles(map, compression.format)) {
            entry.details.push_back(makeDetail(file.metric, double(file.bytes)));
            const double bytes = cageFileBytes_ + double(file.bytes);
            entry.diskBytes = entry.diskBytes == 0 ? bytes : std::min(entry.diskBytes, bytes);
        }
        return entry;
    }

    /// An entry of a mesh in a layout, with as many vertex invocations as indices. Without bytes on disk.
    static Entry makeMeshEntry(Method method, const DenseLayout& layout, DenseMesh mesh, const MeshError& error) {
        const MeshCounts counts = countMesh(mesh);
        Entry entry{.method = method, .error = error, .triangles = counts.triangles};
        entry.residentBytes = double(denseBytes(counts.vertices, counts.triangles, layout));
        entry.uploadedBytes = double(computePosedDenseBytes(layout, counts.vertices));
        entry.traffic = computeDenseTraffic(layout, counts, 3 * counts.triangles);
        entry.mesh = std::move(mesh);
        return entry;
    }

    void addDense(std::vector<Entry>& entries, double tolerance) {
        const int rate = findSmallestRate(tolerance);
        if (rate == 0) return addNote("dense mesh", tolerance);
        Compression compression = study_.uncompressed();
        compression.rate = rate;
        const MeshError error = study_.evaluate(compression).error;
        addMesh(entries, kDenseMethods, {study_.makeMesh(compression), error}, tolerance,
                {makeDetail(Metric::rate, rate)});
    }

    void addSimplified(std::vector<Entry>& entries, double tolerance) {
        const auto found = std::ranges::find_if(simplified_, [&](const auto& s) { return s.second.rms <= tolerance; });
        if (found == simplified_.end()) return addNote("simplified mesh", tolerance);
        addMesh(entries, kSimplifiedMethods, *found, tolerance, {});
    }

    /// A mesh that meets the tolerance: raw, quantised, and by Draco.
    void addMesh(std::vector<Entry>& entries, const MeshMethods& methods, const std::pair<DenseMesh, MeshError>& mesh,
                 double tolerance, std::vector<Value> details) {
        Entry raw = makeMeshEntry(methods.raw, kRawLayout, mesh.first, mesh.second);
        raw.diskBytes = raw.residentBytes;
        raw.isTimed = true;
        raw.details = std::move(details);
        entries.push_back(std::move(raw));

        const EncodedMesh encoded = quantiseMesh(mesh.first);
        const MeshError error = study_.computeError(encoded.decoded);
        Entry quantised = makeMeshEntry(methods.quantised, kQuantisedLayout, encoded.decoded, error);
        RELIEF_CHECK(quantised.residentBytes == double(encoded.residentBytes));
        quantised.diskBytes = double(encoded.diskBytes);
        if (error.rms <= kSlack * tolerance) entries.push_back(std::move(quantised));

        addDraco(entries, methods.draco, mesh.first, tolerance);
    }

    /// The smallest geometry image. Its triangles are drawn as a mesh: the times of that are not its own.
    void addImage(std::vector<Entry>& entries, double tolerance) {
        const MeasuredImage* found = images_.findSmallest(tolerance);
        if (found == nullptr) return addNote(toWord(Method::geometryImage), tolerance);
        const std::uint64_t bytes = geometryImageBytes(found->image.size);
        Entry entry{.method = Method::geometryImage, .error = found->error, .mesh = toMesh(found->image)};
        entry.triangles = entry.mesh->indices.size() / 3;
        entry.residentBytes = entry.uploadedBytes = double(bytes);
        entry.diskBytes = double(measureImageFile(found->image));
        entry.traffic = {.cached = bytes, .uncached = 3 * entry.triangles * 2 * sizeof(vec3)};
        entry.details = {makeDetail(Metric::imageColumns, found->image.size)};
        entries.push_back(std::move(entry));
    }

    /// Encodes a mesh with as few bits as the tolerance allows.
    void addDraco(std::vector<Entry>& entries, Method method, const DenseMesh& mesh, double tolerance) {
        for (int bits = 8; bits <= 18; ++bits) {
            // A coordinate is off by up to half a step, evenly: across the surface an RMS error of a step / sqrt(12).
            const double predicted = std::exp2(-bits) / std::sqrt(12.0);
            if (predicted > 0.5 * tolerance) continue;
            const EncodedMesh encoded = encodeWithDraco(mesh, bits);
            const MeshError error = study_.computeError(encoded.decoded);
            if (error.rms > kSlack * tolerance) continue;
            Entry entry{.method = method, .error = error, .triangles = countMesh(encoded.decoded).triangles};
            entry.diskBytes = double(encoded.diskBytes);
            entry.details = {makeDetail(Metric::positionBits, bits)};
            entries.push_back(std::move(entry));
            return;
        }
        addNote(toWord(method), tolerance);
    }

    /// Meshes of fewer and fewer triangles up to an error of `coarsest`; in the end the smallest stands first.
    void makeSimplified(double coarsest) {
        DenseMesh mesh = study_.makeMesh(study_.uncompressed());
        for (int step = 0; step < 24; ++step) {
            const std::size_t before = countMesh(mesh).triangles;
            mesh = simplifyMesh(mesh, std::size_t(double(before) / std::sqrt(2.0)));
            if (countMesh(mesh).triangles > before * 9 / 10) break; // seams keep it from getting smaller
            const MeshError error = study_.computeError(mesh);
            simplified_.emplace_back(mesh, error);
            if (error.rms > coarsest) break;
        }
        std::ranges::reverse(simplified_);
    }

    /// Maps of halves and of 16 bits look as maps of floats do: they are drawn `withAll`, or not at all.
    static std::vector<PicturedMethod> listPictures(const std::vector<Entry>& entries, bool withAll) {
        std::vector<PicturedMethod> all;
        for (const Entry& entry : entries) {
            const bool looksLikeFloats = entry.method == Method::cageHalfMap || entry.method == Method::cageUnorm16Map;
            if (entry.mesh || (entry.compression && (withAll || !looksLikeFloats)))
                all.push_back({entry.method, entry.compression, entry.mesh ? &*entry.mesh : nullptr, entry.isTimed});
        }
        return all;
    }

    void addRow(const Entry& entry, double tolerance) {
        RELIEF_CHECK(entry.error.rms <= kSlack * tolerance);
        Row row{Suite::bandwidth, study_.scene().name, entry.method, Axis::tolerance, tolerance, {}};
        row.addMeasured(Metric::rmsError, entry.error.rms);
        row.addMeasured(Metric::hausdorffError, entry.error.hausdorff);
        row.addMeasured(Metric::triangles, double(entry.triangles));
        row.addMeasured(Metric::diskBytes, entry.diskBytes);
        // What a method is not used for has no value. The bytes of meshes follow from their counts.
        if (entry.mesh)
            row.addComputed(Metric::residentBytes, entry.residentBytes);
        else if (entry.residentBytes > 0)
            row.addMeasured(Metric::residentBytes, entry.residentBytes);
        if (entry.traffic.cached > 0) {
            row.addComputed(Metric::bytesReadCached, double(entry.traffic.cached));
            row.addComputed(Metric::bytesReadUncached, double(entry.traffic.uncached));
        }
        if (entry.uploadedBytes > 0) row.addComputed(Metric::uploadedBytes, entry.uploadedBytes);
        row.values.insert(row.values.end(), entry.details.begin(), entry.details.end());
        pictures_.addTo(row);
        context_.results.rows.push_back(row);
    }

    void addNote(const std::string& method, double tolerance) {
        context_.results.notes.push_back(
            fmt::format("bandwidth: {}: {} does not meet a tolerance of {:g}", study_.scene().name, method, tolerance));
    }

    SuiteContext& context_;
    CompressionStudy study_;
    GeometryImageStudy images_;
    PictureComparison pictures_;
    double cageFileBytes_;
    std::vector<std::pair<DenseMesh, MeshError>> simplified_;
};

} // namespace

void measureBandwidth(SuiteContext& context, const TestScene& scene) { BandwidthSuite(context, scene).run(); }

} // namespace relief

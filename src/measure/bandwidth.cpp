// The suite `bandwidth`: bytes at equal error. For every tolerance each contestant is made as small as it can be with
// an RMS distance to the reference surface that still meets it; every one that is reported was measured.
#include <algorithm>
#include <cmath>

#include "measure/contest.h"
#include "measure/looks.h"

namespace relief {
namespace {

constexpr MapFormat kFormats[] = {MapFormat::real, MapFormat::half, MapFormat::unorm16, MapFormat::unorm8,
                                  MapFormat::bc4};
constexpr int kMostTries = 2; ///< with maps of one size that promise to meet a tolerance and do not

/// What a contestant is at one tolerance.
struct Entry {
    std::string name;
    MeshError error;
    std::uint64_t triangles = 0;
    double disk = 0, resident = 0, uploaded = 0; ///< bytes; 0: not for that
    Traffic traffic;
    std::optional<Saving> saving;  ///< what is drawn: a surface,
    std::optional<DenseMesh> mesh; ///< or a mesh
    bool isTimed = false;
    std::vector<Value> details;
};

double squared(double x) { return x * x; }
Value number(const char* name, int value) { return {name, "", Origin::measured, {double(value)}}; }

class Bandwidth {
public:
    Bandwidth(Bench& bench, const Subject& subject)
        : bench_(bench),
          contest_(bench.device, subject, bench.options.isQuick ? 6e4 : 1e6, bench.options.isQuick ? 40'000 : 100'000),
          looks_(bench, contest_), cageFileBytes_(double(cageFileBytes(subject.cage))) {}

    void run() {
        const std::vector<double> all = tolerances();
        makeSimplified(all.back());
        for (const double tolerance : all) {
            std::vector<Entry> entries;
            for (const MapFormat format : kFormats) addSurface(entries, tolerance, format);
            addDense(entries, tolerance);
            addSimplified(entries, tolerance);
            looks_.judge(tolerance, drawables(entries, tolerance == all.front()));
            for (const Entry& entry : entries) addRow(entry, tolerance);
            bench_.progress.advance();
        }
    }

private:
    /// As the dense mesh of a million triangles, to two digits upwards; and round ones below the heights themselves.
    std::vector<double> tolerances() {
        const double same = errorAtRate(contest_.referenceRate() / 2);
        const double unit = std::pow(10, std::floor(std::log10(same)) - 1);
        std::vector<double> all{std::ceil(same / unit) * unit};
        const double most = 0.5 * contest_.heightRms();
        for (const double round : {1e-5, 2e-5, 5e-5, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3})
            if (round > 1.99 * all.back() && round < most && all.size() < (bench_.options.isQuick ? 1u : 3u))
                all.push_back(round);
        return all;
    }

    double errorAtRate(int rate) {
        Saving saving = contest_.everything();
        saving.rate = rate;
        return contest_.errorOf(saving).rms;
    }

    /// The smallest rate that meets the tolerance with nothing else saved; 0: none.
    int smallestRate(double tolerance) {
        int low = 0, high = contest_.largestRate();
        if (errorAtRate(high) > tolerance) return 0;
        while (high - low > 1) {
            const int middle = (low + high) / 2;
            (errorAtRate(middle) <= tolerance ? high : low) = middle;
        }
        return high;
    }

    /// What a saving alone adds to the error, squared: errors of different causes hardly know each other.
    double excess(const Saving& saving) {
        return std::max(0.0,
                        squared(contest_.errorOf(saving).rms) - squared(contest_.errorOf(contest_.everything()).rms));
    }

    double residentOf(const Saving& saving) {
        return double(contest_.surfaceBytes(saving.isolation) +
                      mapBytes(saving.format, saving.side, contest_.rowsOf(saving.side)));
    }

    /// Predicted from each saving alone, without the rate.
    double predictedSquare(const Saving& saving) {
        Saving isolation = contest_.everything(), side = contest_.everything();
        isolation.isolation = saving.isolation;
        side.side = saving.side;
        return excess(isolation) + excess(side) + squared(contest_.formatError(saving.side, saving.format));
    }

    /// Smallest first: savings that are predicted to leave room for a rate.
    std::vector<Saving> promising(double tolerance, MapFormat format) {
        std::vector<Saving> all;
        std::vector<int> sides = contest_.sides(), isolations{0, 1, 2, 3, 4, 6};
        std::erase_if(isolations, [&](int i) { return i > contest_.subject().surface.isolation; });
        // Coarser never gets better: what is beyond the tolerance alone need not be measured further down.
        std::ranges::reverse(isolations);
        for (const int isolation : isolations) {
            Saving saving{isolation, contest_.everything().side, format, contest_.largestRate()};
            const auto isBeyond = [&](int side) {
                saving.side = side;
                return predictedSquare(saving) > squared(tolerance);
            };
            const auto first = std::ranges::partition_point(sides, isBeyond);
            if (first == sides.end()) break;
            for (const int side : std::span(first, sides.end())) saving.side = side, all.push_back(saving);
        }
        std::ranges::sort(all, {}, [&](const Saving& s) { return residentOf(s); });
        return all;
    }

    /// The smallest rate that leaves this saving within the tolerance, by prediction and then by measure; 0: none.
    int rateOf(Saving saving, double tolerance) {
        const double left = squared(tolerance) - predictedSquare(saving);
        int rate = left > 0 ? smallestRate(std::sqrt(left)) : 0;
        for (int tries = 0; tries < 2; ++tries) {
            saving.rate = rate == 0 ? contest_.largestRate() : rate;
            if (contest_.errorOf(saving).rms <= tolerance) return saving.rate;
            if (saving.rate == contest_.largestRate()) return 0;
            rate = std::min(contest_.largestRate(), rate + std::max(1, rate / 4));
        }
        return 0;
    }

    void addSurface(std::vector<Entry>& entries, double tolerance, MapFormat format) {
        std::map<int, int> failures; // by the size of the map
        for (Saving& saving : promising(tolerance, format)) {
            if (failures[saving.side] == kMostTries) continue;
            saving.rate = rateOf(saving, tolerance);
            if (saving.rate == 0) {
                ++failures[saving.side];
                continue;
            }
            entries.push_back(entryOf(saving));
            return;
        }
        note(fmt::format("cage + {} map", wordOf(kMapFormats, format)), tolerance);
    }

    Entry entryOf(const Saving& saving) {
        const HeightMap& map = contest_.map(saving.side, saving.format).decoded;
        const Judged& judged = contest_.judged(saving);
        Entry entry{.name = fmt::format("cage + {} map", wordOf(kMapFormats, saving.format)), .error = judged.error};
        entry.triangles = judged.counts.triangles;
        entry.resident = double(judged.residentBytes);
        entry.isTimed = true;
        entry.uploaded = double(posedCageBytes(contest_.subject().cage.positions.size()));
        entry.traffic = surfaceTraffic(
            {.residentBytes = judged.residentBytes, .calls = judged.counts.vertices, .evaluation = judged.evaluation});
        entry.saving = saving;
        entry.details = {number("map columns", saving.side), number("rate", saving.rate),
                         number("isolation", saving.isolation)};
        for (const MapFile& file : mapFiles(map, saving.format)) {
            entry.details.push_back({"map file, " + file.codec, "bytes", Origin::measured, {double(file.bytes)}});
            if (entry.disk == 0 || cageFileBytes_ + double(file.bytes) < entry.disk)
                entry.disk = cageFileBytes_ + double(file.bytes);
        }
        return entry;
    }

    Entry denseEntry(const std::string& name, DenseMesh mesh, const MeshError& error) {
        const MeshCounts counts{mesh.positions.size(), mesh.indices.size() / 3};
        Entry entry{.name = name, .error = error, .triangles = counts.triangles};
        entry.resident = entry.disk = double(residentBytes(kRawLayout, counts));
        entry.uploaded = double(posedDenseBytes(kRawLayout, counts.vertices));
        entry.traffic = denseTraffic(kRawLayout, counts, 3 * counts.triangles);
        entry.mesh = std::move(mesh);
        entry.isTimed = true;
        return entry;
    }

    void addDense(std::vector<Entry>& entries, double tolerance) {
        const int rate = smallestRate(tolerance);
        if (rate == 0) return note("dense mesh", tolerance);
        Saving saving = contest_.everything();
        saving.rate = rate;
        const DenseMesh mesh = contest_.mesh(saving);
        entries.push_back(denseEntry("dense mesh, raw", mesh, contest_.errorOf(saving)));
        entries.back().details = {number("rate", rate)};
        addEncoded(entries, "dense mesh", mesh, tolerance);
    }

    void addSimplified(std::vector<Entry>& entries, double tolerance) {
        const auto found = std::ranges::find_if(simplified_, [&](const auto& s) { return s.second.rms <= tolerance; });
        if (found == simplified_.end()) return note("simplified mesh", tolerance);
        entries.push_back(denseEntry("simplified mesh, raw", found->first, found->second));
        addEncoded(entries, "simplified mesh", found->first, tolerance);
    }

    /// The mesh quantised, and through Draco with as few bits as the tolerance allows.
    void addEncoded(std::vector<Entry>& entries, const std::string& name, const DenseMesh& mesh, double tolerance) {
        EncodedMesh encoded = quantised(mesh);
        const MeshCounts counts{encoded.decoded.positions.size(), encoded.decoded.indices.size() / 3};
        Entry entry{
            .name = name + ", quantised", .error = contest_.errorOf(encoded.decoded), .triangles = counts.triangles};
        entry.resident = double(encoded.residentBytes), entry.disk = double(encoded.diskBytes);
        entry.uploaded = double(posedDenseBytes(kQuantisedLayout, counts.vertices));
        entry.traffic = denseTraffic(kQuantisedLayout, counts, 3 * counts.triangles);
        entry.mesh = std::move(encoded.decoded);
        if (entry.error.rms <= 1.02 * tolerance) entries.push_back(std::move(entry)); // a mesh at the brink may pass it
        for (int bits = 8; bits <= 18; ++bits) {
            // A coordinate is off by up to half a step, evenly; across the surface that is an RMS of a step / sqrt(12).
            const double step = std::exp2(-bits) / std::sqrt(12.0);
            if (step > 0.5 * tolerance) continue;
            encoded = dracoEncoded(mesh, bits);
            const MeshError error = contest_.errorOf(encoded.decoded);
            if (error.rms > 1.02 * tolerance) continue;
            Entry draco{.name = "Draco, " + name, .error = error, .triangles = counts.triangles};
            draco.disk = double(encoded.diskBytes);
            draco.details = {number("position bits", bits)};
            entries.push_back(std::move(draco));
            return;
        }
        note("Draco, " + name, tolerance);
    }

    /// A chain of simpler and simpler meshes, the smallest first in the end.
    void makeSimplified(double coarsest) {
        DenseMesh mesh = contest_.mesh(contest_.everything());
        for (int step = 0; step < 24; ++step) {
            const std::size_t before = mesh.indices.size() / 3;
            mesh = simplified(mesh, std::size_t(double(before) / std::sqrt(2.0)));
            if (mesh.indices.size() / 3 > before * 9 / 10) break; // seams hold it
            const MeshError error = contest_.errorOf(mesh);
            simplified_.emplace_back(mesh, error);
            if (error.rms > coarsest) break;
        }
        std::ranges::reverse(simplified_);
    }

    /// Maps of halves and of 16 bits look as floats do: they are drawn with all others, or not at all.
    static std::vector<Drawable> drawables(const std::vector<Entry>& entries, bool withAll) {
        std::vector<Drawable> all;
        for (const Entry& entry : entries) {
            const bool isAlike =
                entry.saving && (entry.saving->format == MapFormat::half || entry.saving->format == MapFormat::unorm16);
            if (entry.mesh || (entry.saving && (withAll || !isAlike)))
                all.push_back({entry.name, entry.saving, entry.mesh ? &*entry.mesh : nullptr, entry.isTimed});
        }
        return all;
    }

    void addRow(const Entry& entry, double tolerance) {
        Row row{"bandwidth", contest_.subject().name, entry.name, "tolerance", tolerance, {}};
        row.add("rms", "of the diagonal", Origin::measured, entry.error.rms);
        row.add("hausdorff", "of the diagonal", Origin::measured, entry.error.hausdorff);
        row.add("triangles", "triangles", Origin::measured, double(entry.triangles));
        row.add("disk", "bytes", Origin::measured, entry.disk);
        if (entry.resident > 0) {
            const Origin origin = entry.mesh ? Origin::computed : Origin::measured;
            row.add("resident", "bytes", origin, entry.resident);
        }
        if (entry.traffic.least > 0) {
            row.add("read a frame, least", "bytes", Origin::computed, double(entry.traffic.least));
            row.add("read a frame, cacheless", "bytes", Origin::computed, double(entry.traffic.cacheless));
        }
        if (entry.uploaded > 0) row.add("uploaded a frame", "bytes", Origin::computed, entry.uploaded);
        row.values.insert(row.values.end(), entry.details.begin(), entry.details.end());
        looks_.tell(entry.name, row);
        bench_.results.rows.push_back(row);
    }

    void note(const std::string& name, double tolerance) {
        bench_.results.notes.push_back(
            fmt::format("bandwidth: {}: {} does not meet {:g} here", contest_.subject().name, name, tolerance));
    }

    Bench& bench_;
    Contest contest_;
    Looks looks_;
    double cageFileBytes_;
    std::vector<std::pair<DenseMesh, MeshError>> simplified_;
};

} // namespace

void measureBandwidth(Bench& bench, const Subject& subject) { Bandwidth(bench, subject).run(); }

} // namespace relief

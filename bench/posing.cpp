#include "posing.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/ompEvaluator.h>

#include "base/checks.h"
#include "base/clock.h"
#include "pose/pose.h"

namespace relief::bench {
namespace {

namespace Osd = OpenSubdiv::Osd;

constexpr int kPosingRounds = 100;

/// The stencils of a surface in the arrays that OpenSubdiv's evaluators take.
struct OsdStencils {
    std::vector<int> sizes, offsets, indices;
    std::vector<float> weights, from, to;

    /// `stencils` must have no shared rows: OpenSubdiv's stencils have only points of the cage.
    OsdStencils(const Stencils& stencils, std::span<const vec3> positions)
        : offsets(stencils.offsets.begin(), stencils.offsets.end() - 1),
          indices(stencils.indices.begin(), stencils.indices.end()), weights(stencils.weights.size()),
          to(3 * stencils.rowCount()) {
        for (std::size_t row = 0; row < stencils.rowCount(); ++row)
            sizes.push_back(int(stencils.offsets[row + 1] - stencils.offsets[row]));
        for (std::size_t row = 0; row < stencils.rowCount(); ++row)
            for (std::uint32_t k = stencils.offsets[row]; k < stencils.offsets[row + 1]; ++k)
                weights[k] = float(stencils.weight(row, k));
        for (const vec3& p : positions) from.insert(from.end(), {p.x, p.y, p.z});
    }

    /// Evaluates all rows once and returns the milliseconds.
    template <typename Evaluator>
    double evaluate() {
        const Osd::BufferDescriptor packed(0, 3, 3);
        return measureMilliseconds([&] {
            Evaluator::EvalStencils(from.data(), packed, to.data(), packed, sizes.data(), offsets.data(),
                                    indices.data(), weights.data(), 0, int(sizes.size()));
        });
    }
};

/// The least time: rounds are short, and other programs on the machine can only lengthen them.
double leastOf(const std::vector<double>& times) { return *std::ranges::min_element(times); }

/// A cage of that many copies of a cage's faces.
Cage repeatFaces(const Cage& cage, std::uint32_t count) {
    Cage all;
    for (std::uint32_t copy = 0; copy < count; ++copy) {
        const auto first = std::uint32_t(all.positions.size());
        for (const vec3& p : cage.positions) all.positions.push_back(p + vec3(50.0f * float(copy), 0, 0));
        all.faceSizes.insert(all.faceSizes.end(), cage.faceSizes.begin(), cage.faceSizes.end());
        for (const std::uint32_t corner : cage.corners) all.corners.push_back(first + corner);
    }
    return all;
}

/// Prints one line for a cage; returns the device's milliseconds. Throws Failure::input where OpenSubdiv cannot have
/// its stencils.
double benchCage(Device& device, const std::string& name, const Cage& cage, const SurfaceOptions& options) {
    const Surface surface = buildSurface(cage, options);
    if (surface.stencils.sharedRowCount > 0)
        fail(Failure::input, "{}: a vertex or face has too many neighbours for OpenSubdiv's stencils", name);
    // The same rows for both sides.
    SurfaceModel model(device, {.surface = &surface, .cagePositions = cage.positions});
    Poser poser(device, model, {.surface = &surface});
    const Pose pose{.positions = cage.positions, .joints = {}, .morphWeights = {}};
    OsdStencils osd(surface.stencils, cage.positions);
    RELIEF_CHECK(osd.sizes.size() == surface.stencils.rowCount());

    // Interleaved rounds; the first one warms up.
    std::vector<double> ours, cpu, omp;
    for (int round = 0; round <= kPosingRounds; ++round) {
        // OpenMP's threads spin for a while after their work: CpuEvaluator, on one thread, runs in that time.
        const double all = osd.evaluate<Osd::OmpEvaluator>(), one = osd.evaluate<Osd::CpuEvaluator>();
        poser.pose(pose);
        if (round == 0) continue;
        ours.push_back(poser.stats().milliseconds);
        cpu.push_back(one);
        omp.push_back(all);
    }
    const double rows = double(surface.stencils.rowCount()) * 1e-3, best = std::min(leastOf(cpu), leastOf(omp));
    std::cout << fmt::format(
        "posing: {:36} {:7} rows of {:4.1f} weights: device {:6.2f} ms ({:6.1f} M/s)  {:4.2f} x the "
        "faster of CpuEvaluator ({:5.1f} M/s) and OmpEvaluator ({:5.1f} M/s); {} uploaded\n",
        fmt::format("{}, isolation {}", name, options.isolation), surface.stencils.rowCount(),
        double(surface.stencils.indices.size()) / double(surface.stencils.rowCount()), leastOf(ours),
        rows / leastOf(ours), best / leastOf(ours), rows / leastOf(cpu), rows / leastOf(omp),
        humanBytes(poser.stats().uploadedBytes));
    return leastOf(ours);
}

} // namespace

void benchPosing() {
    Device device;
    const char* data = std::getenv("RELIEF_DATA");
    const std::string path = (data != nullptr ? data : RELIEF_SOURCE "/../shared/data") + std::string("/bigguy.obj");
    const bool isThere = std::filesystem::exists(path);
    const std::string name = isThere ? "bigguy" : "octopus";
    const Cage cage = readCage(isThere ? path : RELIEF_SOURCE "/meshes/octopus.obj");
    // The same surface, exact with few points and approximate with many.
    const double exact = benchCage(device, name, cage, {.isolation = neededIsolation(cage, EndCapKind::exact)});
    const double gregory =
        benchCage(device, name + ", Gregory", cage, {.isolation = 6, .endCaps = EndCapKind::gregory});
    std::cout << fmt::format("posing: the surface of {} in {:.2f} of the time that Gregory patches take\n", name,
                             exact / gregory);
    const auto copies = std::uint32_t(20'000 / cage.faceCount() + 1);
    const Cage large = repeatFaces(cage, copies);
    benchCage(device, fmt::format("{} x {}, {} faces", copies, name, large.faceCount()), large, {.isolation = 3});
}

} // namespace relief::bench

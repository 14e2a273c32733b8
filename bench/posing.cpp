#include "posing.h"

#include <cstdlib>
#include <filesystem>
#include <iostream>

#include <opensubdiv/osd/cpuEvaluator.h>
#include <opensubdiv/osd/ompEvaluator.h>

#include "pose/pose.h"
#include "timing.h"

namespace relief::bench {
namespace {

namespace Osd = OpenSubdiv::Osd;

constexpr int kPosingRounds = 15;

/// The same stencils as OpenSubdiv's evaluators take them.
struct OsdStencils {
    std::vector<int> sizes, offsets, indices;
    std::vector<float> weights, from, to;

    /// Theirs are of the cage's points alone: there are no shared rows.
    OsdStencils(const Stencils& stencils, std::span<const vec3> positions)
        : offsets(stencils.offsets.begin(), stencils.offsets.end() - 1),
          indices(stencils.indices.begin(), stencils.indices.end()), weights(stencils.weights),
          to(3 * stencils.rowCount()) {
        for (std::size_t row = 0; row < stencils.rowCount(); ++row)
            sizes.push_back(int(stencils.offsets[row + 1] - stencils.offsets[row]));
        for (const vec3& p : positions) from.insert(from.end(), {p.x, p.y, p.z});
    }

    template <typename Evaluator>
    double time() {
        const Osd::BufferDescriptor packed(0, 3, 3);
        return millisecondsOf([&] {
            Evaluator::EvalStencils(from.data(), packed, to.data(), packed, sizes.data(), offsets.data(),
                                    indices.data(), weights.data(), 0, int(sizes.size()));
        });
    }
};

/// So many copies of a cage's polygons in one.
Cage repeated(const Cage& cage, std::uint32_t count) {
    Cage all;
    for (std::uint32_t copy = 0; copy < count; ++copy) {
        const auto first = std::uint32_t(all.positions.size());
        for (const vec3& p : cage.positions) all.positions.push_back(p + vec3(50.0f * float(copy), 0, 0));
        all.faceSizes.insert(all.faceSizes.end(), cage.faceSizes.begin(), cage.faceSizes.end());
        for (const std::uint32_t corner : cage.corners) all.corners.push_back(first + corner);
    }
    return all;
}

void benchCage(Device& device, const std::string& name, const Cage& cage, int isolation) {
    const Surface surface = buildSurface(cage, {.isolation = isolation});
    if (surface.stencils.sharedRowCount > 0)
        fail(Failure::input, "{}: a vertex or face has too many neighbours for OpenSubdiv's stencils", name);
    SurfaceModel model(device, {.surface = &surface, .cagePositions = cage.positions});
    Poser poser(device, model, {.surface = &surface});
    const Pose pose{.positions = cage.positions, .joints = {}, .morphWeights = {}};
    OsdStencils osd(surface.stencils, cage.positions);
    std::vector<double> ours, cpu, omp;
    for (int round = 0; round <= kPosingRounds; ++round) {
        // OpenMP's threads go on spinning for a while: what comes behind it on one thread gives them time to rest.
        const double all = osd.time<Osd::OmpEvaluator>(), one = osd.time<Osd::CpuEvaluator>();
        poser.pose(pose);
        if (round == 0) continue;
        ours.push_back(poser.stats().milliseconds);
        cpu.push_back(one);
        omp.push_back(all);
    }
    const double rows = double(surface.stencils.rowCount()) * 1e-3, best = std::min(median(cpu), median(omp));
    std::cout << fmt::format(
        "posing: {:36} {:7} rows of {:4.1f} weights: device {:6.2f} ms ({:6.1f} M/s)  {:4.2f} x the "
        "faster of CpuEvaluator ({:5.1f} M/s) and OmpEvaluator ({:5.1f} M/s); {} uploaded\n",
        fmt::format("{}, isolation {}", name, isolation), surface.stencils.rowCount(),
        double(surface.stencils.indices.size()) / double(surface.stencils.rowCount()), median(ours),
        rows / median(ours), best / median(ours), rows / median(cpu), rows / median(omp),
        humanBytes(poser.stats().uploadedBytes));
}

} // namespace

void benchPosing() {
    Device device;
    const char* data = std::getenv("RELIEF_DATA");
    const std::string path = (data != nullptr ? data : RELIEF_SOURCE "/../shared/data") + std::string("/bigguy.obj");
    const bool isThere = std::filesystem::exists(path);
    const std::string name = isThere ? "bigguy" : "octopus";
    const Cage cage = readCage(isThere ? path : RELIEF_SOURCE "/meshes/octopus.obj");
    for (const int isolation : {3, 6}) benchCage(device, name, cage, isolation);
    const auto copies = std::uint32_t(20'000 / cage.faceCount() + 1);
    const Cage large = repeated(cage, copies);
    benchCage(device, fmt::format("{} x {}, {} faces", copies, name, large.faceCount()), large, 3);
}

} // namespace relief::bench

// Every cage of the zoo, with every height and in every pose, is watertight to the bit on every path.
#include <cstdio>
#include <cstdlib>

#include "check/check.h"
#include "loads.h"

namespace relief::test {
namespace {

class Zoo : public OnDevice {};

/// A twentieth of the combinations, and paths that take turns: for drivers that compile slowly, and for sanitizers.
bool isQuick() { return std::getenv("RELIEF_ZOO_QUICK") != nullptr; }

struct Tally {
    std::size_t combinations = 0, captures = 0, triangles = 0;
};

/// All cages of a pen with one height, in one pose.
struct Load {
    const Pen& pen;
    const SurfaceModel& model;
    std::string words;
};

void expectWatertight(const Load& load, const EdgeRates& rates, Path path, Tally& tally) {
    const CapturedMesh mesh = capturer().capture(load.model, {.path = path}, rates);
    const Watertightness w = checkWatertight(mesh, boundarySegments(load.model, rates));
    EXPECT_GT(w.triangles, 0u) << load.words;
    EXPECT_TRUE(w.isWatertight()) << fmt::format(
        "{}, {}, {}: {} open edges, {} T-junctions, {} not finite, {} + {} hidden of {} boundary segments; {} ulp at "
        "({}, {}, {})",
        load.pen.nameAt(w.worstLocation), load.words, kPathNames[int(path)], w.openEdges, w.tJunctions, w.notFinite,
        w.boundarySegments, w.hiddenBoundarySegments, w.expectedBoundarySegments, w.largestGapUlps, w.worstLocation.x,
        w.worstLocation.y, w.worstLocation.z);
    tally.combinations += load.pen.cages.size();
    tally.triangles += w.triangles;
    ++tally.captures;
}

/// Whether a pen is loaded with this height in this pose: few cages cost as much as many and are visited less often. In
/// a quick run three pens of four are loaded once, and together they meet every height in every pose.
bool isVisited(const Pen& pen, std::size_t number, Pose pose, std::size_t map, std::size_t mapCount) {
    if (map + kVectorMaps >= mapCount && (pose != Pose::twist || pen.isSmall())) return false;
    if (isQuick()) return (number + std::size_t(pose) * mapCount + map) % 20 == 0;
    return (number + std::size_t(pose) + map) % (pen.isSmall() ? 3 : 2) == 0;
}

/// Poses a pen, loads it with heights and captures it on every path; kinds of rates take turns.
void visit(const Pen& pen, std::size_t number, std::uint32_t& turn, Tally& tally) {
    static const std::vector<NamedMap> maps = zooMaps();
    const std::vector<Path> paths = capturedPaths();
    const Surface surface = buildSurface(pen.joined(), {.scheme = pen.scheme, .isolation = 2});
    for (const Pose pose : kPoses) {
        const std::vector<vec3> positions = pen.posedTogether(pose);
        for (std::size_t map = 0; map < maps.size(); ++map) {
            if (!isVisited(pen, number, pose, map, maps.size())) continue;
            const SurfaceModel model(device(),
                                     {.surface = &surface, .cagePositions = positions, .height = maps[map].get()});
            const auto kind = RateKind(++turn % kRateKinds);
            const EdgeRates rates = zooRates(model, kind, turn);
            const Load load{pen, model, fmt::format("{}, {}, {}", kPoseNames[int(pose)], maps[map].name, nameOf(kind))};
            for (const Path path : paths)
                if (!isQuick() || path == paths[turn % paths.size()]) expectWatertight(load, rates, path, tally);
        }
    }
}

// About 2100 combinations: half of all cages x 5 heights x 3 poses x 3 paths, of cages with rare rules a third; of the
// others a vector map in one pose. Ten kinds of rates take turns over heights and poses, and the turns of a pen begin
// with another kind.
TEST_F(Zoo, isWatertight) {
    Tally tally;
    std::uint32_t turn = 0;
    std::size_t number = 0;
    for (const Pen& pen : zooPens()) {
        visit(pen, number++, turn, tally);
        turn += 3;
    }
    std::printf("%zu combinations in %zu captures, %zu triangles\n", tally.combinations, tally.captures,
                tally.triangles);
}

} // namespace
} // namespace relief::test

// Every cage of the zoo, with every height and in every pose, is watertight to the bit on every path.
#include <cstdio>
#include <cstdlib>

#include "check/check.h"
#include "loads.h"

namespace relief::test {
namespace {

class Zoo : public OnDevice {};

/// Under sanitizers paths take turns over the combinations.
#ifdef __SANITIZE_ADDRESS__
constexpr bool kIsSlow = true;
#else
constexpr bool kIsSlow = false;
#endif

/// A third of the combinations, and paths that take turns: for drivers that compile slowly.
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

/// Poses a pen, loads it with every height and captures it on every path; kinds of rates take turns.
void visit(const Pen& pen, std::uint32_t& turn, Tally& tally) {
    static const std::vector<NamedMap> maps = zooMaps();
    const std::vector<Path> paths = capturedPaths();
    const Surface surface = buildSurface(pen.joined(), {.scheme = pen.scheme, .isolation = 2});
    for (const Pose pose : kPoses) {
        const std::vector<vec3> positions = pen.posedTogether(pose);
        for (std::size_t map = 0; map < maps.size(); ++map) {
            if ((pen.isSmall() || isQuick()) && (std::size_t(pose) + map) % 3 != 0) continue;
            const SurfaceModel model(device(),
                                     {.surface = &surface, .cagePositions = positions, .height = maps[map].get()});
            const auto kind = RateKind(++turn % kRateKinds);
            const EdgeRates rates = zooRates(model, kind, turn);
            const Load load{pen, model, fmt::format("{}, {}, {}", kPoseNames[int(pose)], maps[map].name, nameOf(kind))};
            for (const Path path : paths)
                if (!(kIsSlow || isQuick()) || path == paths[turn % paths.size()])
                    expectWatertight(load, rates, path, tally);
        }
    }
}

// About 4000 combinations: all cages x 5 heights x 3 poses x 3 paths, of cages with rare rules a third. Ten kinds of
// rates take turns over heights and poses: 15 turns show a cage all of them, and the turns of a pen begin with another
// kind. Under sanitizers paths take turns as well.
TEST_F(Zoo, isWatertight) {
    Tally tally;
    std::uint32_t turn = 0;
    for (const Pen& pen : zooPens()) {
        visit(pen, turn, tally);
        turn += 3;
    }
    std::printf("%zu combinations in %zu captures, %zu triangles\n", tally.combinations, tally.captures,
                tally.triangles);
}

} // namespace
} // namespace relief::test

// The three paths draw the same picture of the zoo, and none of them a crack.
#include "check/check.h"
#include "loads.h"
#include "pictures.h"

namespace relief::test {
namespace {

class ZooPictures : public OnDevice {};

/// Root mean square of the difference over all channels.
double difference(const Picture& a, const Picture& b) {
    const std::vector<float> left = a.image().texels, right = b.image().texels;
    double sum = 0;
    for (std::size_t i = 0; i < left.size(); ++i) {
        const double d = double(left[i]) - double(right[i]);
        EXPECT_TRUE(std::isfinite(d));
        sum += d * d;
    }
    return std::sqrt(sum / double(left.size()));
}

/// One-sided, or drawn twice at the same position: which of two faces is seen depends on the order of triangles.
bool isDrawnTwice(const std::string& name) {
    for (const char* word : {"moebius", "pillow", "backToBack", "Collapsed", "book", "twistedPair", "glued"})
        if (name.find(word) != std::string::npos) return true;
    return false;
}

// The paths join equal samples along edges and inside quads, by other diagonals, and the tessellator's rings inside
// triangles are its own. Of smooth heights that are resolved well a few thousandths of a normal remain (the most here
// is 0.007); inside triangles and beside the steps in height along bilinear seams it is twice as much (0.014).
TEST_F(ZooPictures, areEqualOnAllPaths) {
    const HeightMap map = sineMap(64, 0.1, 1);
    std::vector<ZooCage> cages = zooCages();
    std::erase_if(cages, [](const ZooCage& one) { return isDrawnTwice(one.name); });
    for (std::size_t i = 0; i < cages.size(); i += 4) {
        const ZooCage& one = cages[i];
        const Surface surface = buildSurface(one.cage, {.scheme = one.scheme, .isolation = 2});
        const std::vector<vec3> positions = posed(one.cage, Pose::twist);
        const SurfaceModel model(device(), {.surface = &surface, .cagePositions = positions, .height = &map});
        RenderOptions options = pictureOptions(positions, {});
        options.rate = 32;
        options.path = Path::dice;
        const Picture diced = renderer().render(model, options);
        for (const Path path : drawnPaths()) {
            if (path == Path::dice) continue;
            options.path = path;
            EXPECT_LT(difference(diced, renderer().render(model, options)), one.scheme == Scheme::catmark ? 0.01 : 0.02)
                << one.name << ", " << kPathNames[int(path)];
        }
    }
}

/// The cages of a pen that have an inside.
Pen closedOnes(const Pen& pen) {
    Pen closed{pen.scheme, {}};
    for (const ZooCage& one : pen.cages)
        if (enclosesVolume(buildSurface(one.cage, {.scheme = one.scheme, .isolation = 1}))) closed.cages.push_back(one);
    return closed;
}

// Fronts and backs add up to nothing along each line of sight, however many cages stand behind each other.
TEST_F(ZooPictures, showNoCracks) {
    const std::vector<NamedMap> maps = zooMaps();
    std::size_t turn = 0;
    for (const Pen& pen : zooPens()) {
        const Pen closed = closedOnes(pen);
        if (closed.isSmall()) continue;
        const Surface surface = buildSurface(closed.joined(), {.scheme = closed.scheme, .isolation = 2});
        const NamedMap& map = maps[1 + ++turn % 4];
        const std::vector<vec3> positions = closed.posedTogether(kPoses[turn % 2]);
        const SurfaceModel model(device(), {.surface = &surface, .cagePositions = positions, .height = map.get()});
        for (const Path path : drawnPaths())
            for (const CameraOptions& view : kCrackViews) {
                RenderOptions options = pictureOptions(positions, view);
                options.path = path;
                if (turn % 2 == 0) options.rate = 9;
                EXPECT_EQ(crackRenderer().crackPixels(model, options, crackShift(2.0 / 9)), 0u)
                    << closed.cages[0].name << " and " << closed.cages.size() - 1 << " more, " << map.name << ", "
                    << kPathNames[int(path)] << ", azimuth " << view.azimuth;
            }
    }
}

} // namespace
} // namespace relief::test

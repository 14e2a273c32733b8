// Tessellation against grid. Both evaluate the surface at the same points when every edge has the same rate, but join
// them by other diagonals, so between the points interpolated positions and normals differ by the twist of one cell: of
// second order in its size. Pixels of the outline are excluded from the colors and counted as coverage instead.
#include "scenes.h"

namespace relief::test {
namespace {

struct Difference {
    double color = 0;      ///< root mean square over pixels that both cover wholly, 0..1
    double clearShare = 0; ///< of those pixels, how many differ by over 0.05 in some channel
    double coverage = 0;   ///< mean over the same pixels' number
};

Difference difference(const Image& a, const Image& b) {
    Difference result;
    double solid = 0;
    for (std::size_t i = 0; i < a.texels.size(); i += 4) {
        const float *p = &a.texels[i], *q = &b.texels[i];
        result.coverage += std::abs(p[3] - q[3]);
        if (p[3] < 1 || q[3] < 1) continue;
        ++solid;
        float largest = 0;
        for (int c = 0; c < 3; ++c) {
            result.color += double(p[c] - q[c]) * (p[c] - q[c]) / 3;
            largest = std::max(largest, std::abs(p[c] - q[c]));
        }
        result.clearShare += largest > 0.05f;
    }
    EXPECT_GT(solid, 2000);
    return {std::sqrt(result.color / solid), result.clearShare / solid, result.coverage / solid};
}

class Paths : public ::testing::Test {
protected:
    SceneFolder scenes_;

    Image draw(const std::string& line) {
        scenes_.render(line + " --size 128,128 --transparent", scenes_ / "a.png");
        return readImage(scenes_ / "a.png");
    }
    Difference betweenPaths(const std::string& line) {
        return difference(draw(line + " --path tessellation"), draw(line + " --path grid"));
    }
};

// Cells of about a pixel. A change of the height by a twentieth, hard to see, is three times what the paths may differ
// by.
TEST_F(Paths, agreeWhereCellsAreSmall) {
    for (const std::string cage : {"^torus", "^lantern"})
        for (const std::string show : {"normal", "shaded"}) {
            SCOPED_TRACE(cage + " " + show);
            const std::string line = cage + " --height @waves.exr --rate 32 --show " + show;
            const Image grid = draw(line + " --path grid --scale 0.04");
            const Difference paths = difference(draw(line + " --path tessellation --scale 0.04"), grid);
            EXPECT_LT(paths.color, 0.003);
            EXPECT_LT(paths.clearShare, 0.001);
            EXPECT_LT(paths.coverage, 0.0003);
            const Difference scales = difference(draw(line + " --path grid --scale 0.042"), grid);
            EXPECT_LT(3 * paths.color, scales.color);
            EXPECT_LT(3 * paths.coverage, scales.coverage);
        }
}

// Eight faces fill the picture: cells of several pixels. Their difference falls with their size, slowly, as the height
// map's mips bring finer waves with every rate.
TEST_F(Paths, agreeMoreAndMoreWhereCellsAreLarge) {
    const std::string line = "@octahedron.obj --scheme loop --height @waves.exr --scale 0.02 --show normal --rate ";
    const Difference coarse = betweenPaths(line + "16"), fine = betweenPaths(line + "32"),
                     finest = betweenPaths(line + "64");
    EXPECT_LT(fine.color, coarse.color);
    EXPECT_LT(finest.color, 0.7 * coarse.color);
    EXPECT_LT(finest.color, 0.01);
}

} // namespace
} // namespace relief::test

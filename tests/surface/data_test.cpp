// Production cages.
#include <random>

#include <gtest/gtest.h>

#include "support.h"
#include "surface/families.h"
#include "surface/flat_surface.h"
#include "surface/oracle.h"
#include "surface/sides.h"

namespace relief {
namespace {

class ProductionCage : public testing::TestWithParam<const char*> {
protected:
    void SetUp() override {
        const std::string folder = test::productionFolder();
        if (folder.empty()) GTEST_SKIP() << "the production meshes are not there: set RELIEF_DATA";
        cage = readCage(folder + "/" + GetParam());
    }
    Cage cage;
};

TEST_P(ProductionCage, FlatArraysHoldTheReferencesPositions) {
    const FlatSurface flat(cage, {});
    const ReferenceSurface reference(cage, {});
    std::mt19937 random(11);
    std::uniform_real_distribution<double> unit(0, 1);
    double worst = 0, worstTex = 0;
    for (std::uint32_t face = 0; face < flat.surface().faces.size(); ++face) {
        for (int i = 0; i < 4; ++i) {
            const dvec2 uv(unit(random), unit(random));
            worst = std::max(worst, glm::length(flat.position(face, uv) - reference.limit(int(face), uv).p));
            if (cage.hasTexCoords())
                worstTex =
                    std::max(worstTex, glm::length(flat.texCoord(face, uv) - reference.texture(int(face), uv).st));
        }
    }
    EXPECT_LE(worst, 1e-6 * boundsOf(cage).diagonal());
    EXPECT_LE(worstTex, 1e-6);
}

TEST_P(ProductionCage, IsExactAtPatchCorners) {
    const int gridSize = 4;
    // The oracle would need one level more per unit of sharpness.
    for (float& sharpness : cage.creaseSharpness) sharpness = 10;
    const Oracle oracle(cage, Scheme::catmark, gridSize);
    const ReferenceSurface reference(cage, {Scheme::catmark, oracle.levels()});
    double worst = 0;
    for (int face = 0; face < reference.faceCount(); ++face)
        for (int j = 0; j <= gridSize; ++j)
            for (int i = 0; i <= gridSize; ++i)
                worst = std::max(worst, glm::length(reference.limit(face, dvec2(i, j) / double(gridSize)).p -
                                                    oracle.position(face, i, j)));
    EXPECT_LE(worst, 1e-13 * sizeOf(cage));
}

TEST_P(ProductionCage, SidesLieOnTheirEdges) {
    const Surface surface = buildSurface(cage, {});
    const ReferenceSurface reference(cage, {});
    double worst = 0;
    atPieces(surface, [&](const Piece& piece) {
        const Incidence& owner = surface.edges.at(piece.edge).owner;
        for (const double t : {0.0, 0.3, 0.5, 1.0})
            worst = std::max(
                worst, glm::length(reference.limit(int(piece.incidence.face), pointOf(surface, piece.incidence, t)).p -
                                   reference.limit(int(owner.face), pointOf(surface, owner, t)).p));
    });
    EXPECT_LE(worst, 1e-12 * boundsOf(cage).diagonal());
}

INSTANTIATE_TEST_SUITE_P(, ProductionCage, testing::Values("bigguy.obj", "car.obj", "monsterfrog.obj"),
                         [](const auto& info) {
                             const std::string file = info.param;
                             return file.substr(0, file.find('.'));
                         });

} // namespace
} // namespace relief

// Gregory bases with true derivatives.
#include <random>

#include <gtest/gtest.h>

#include "surface/families.h"
#include "surface/far.h"
#include "surface/gregory.h"

namespace relief {
namespace {

using Weights = PatchWeights (*)(double, double);

void expectPartitionOfUnity(const PatchWeights& weights) {
    Jet sum;
    for (const Jet& w : weights) sum = sum + w;
    EXPECT_NEAR(sum.f, 1, 1e-14);
    for (const double derivative : {sum.u, sum.v, sum.uu, sum.uv, sum.vv}) EXPECT_NEAR(derivative, 0, 1e-12);
}

TEST(GregoryBases, SumToOneAndTheirDerivativesToZero) {
    for (const dvec2& uv : {dvec2(0), dvec2(1, 0), dvec2(0, 1), dvec2(0.2, 0.3), dvec2(0.5, 0.5), dvec2(0, 0.4)}) {
        expectPartitionOfUnity(gregoryQuadWeights(uv.x, uv.y));
        expectPartitionOfUnity(gregoryTriangleWeights(uv.x, uv.y));
    }
    expectPartitionOfUnity(gregoryQuadWeights(1, 1));
}

/// Worst difference of each weight's derivatives from central differences, at points inside the domain.
void expectTrueDerivatives(Weights basis, const dvec2& uv) {
    const double h = 1e-4;
    const auto at = [&](int a, int b) { return basis(uv.x + a * h, uv.y + b * h); };
    const auto c = at(0, 0), e = at(1, 0), w = at(-1, 0), n = at(0, 1), s = at(0, -1);
    const auto ne = at(1, 1), nw = at(-1, 1), se = at(1, -1), sw = at(-1, -1);
    for (int i = 0; i < kMostPatchPoints; ++i) {
        EXPECT_NEAR(c[i].u, (e[i].f - w[i].f) / (2 * h), 1e-6) << i;
        EXPECT_NEAR(c[i].v, (n[i].f - s[i].f) / (2 * h), 1e-6) << i;
        EXPECT_NEAR(c[i].uu, (e[i].f - 2 * c[i].f + w[i].f) / (h * h), 1e-4) << i;
        EXPECT_NEAR(c[i].vv, (n[i].f - 2 * c[i].f + s[i].f) / (h * h), 1e-4) << i;
        EXPECT_NEAR(c[i].uv, (ne[i].f - nw[i].f - se[i].f + sw[i].f) / (4 * h * h), 1e-4) << i;
    }
}

TEST(GregoryBases, HaveTrueDerivatives) {
    for (const dvec2 uv : {dvec2(0.3, 0.2), dvec2(0.1, 0.6), dvec2(0.45, 0.5), dvec2(0.05, 0.04)}) {
        expectTrueDerivatives(gregoryQuadWeights, uv);
        expectTrueDerivatives(gregoryTriangleWeights, uv);
    }
    expectTrueDerivatives(gregoryQuadWeights, {0.9, 0.8});
}

/// A corner of the domain and a direction into it.
struct Step {
    dvec2 corner, inward;
};

// In a corner the rational weights' second derivatives depend on the direction: the diagonal's is taken.
TEST(GregoryBases, HaveFiniteDerivativesInCorners) {
    for (const Step& step : {Step{{0, 0}, {1, 1}}, {{1, 0}, {-1, 1}}, {{1, 1}, {-1, -1}}, {{0, 1}, {1, -1}}}) {
        const auto at = gregoryQuadWeights(step.corner.x, step.corner.y);
        const auto beside =
            gregoryQuadWeights(step.corner.x + 1e-7 * step.inward.x, step.corner.y + 1e-7 * step.inward.y);
        for (int i = 0; i < kGregoryQuadPoints; ++i) {
            EXPECT_NEAR(at[i].u, beside[i].u, 1e-5) << i;
            EXPECT_NEAR(at[i].uu, beside[i].uu, 1e-4) << i;
            EXPECT_NEAR(at[i].uv, beside[i].uv, 1e-4) << i;
            EXPECT_NEAR(at[i].vv, beside[i].vv, 1e-4) << i;
        }
    }
    // A triangle's corner is left along the line on which its two other barycentrics are equal.
    for (const Step& step : {Step{{0, 0}, {1, 1}}, {{1, 0}, {-2, 1}}, {{0, 1}, {1, -2}}}) {
        const auto at = gregoryTriangleWeights(step.corner.x, step.corner.y);
        const auto beside =
            gregoryTriangleWeights(step.corner.x + 1e-7 * step.inward.x, step.corner.y + 1e-7 * step.inward.y);
        for (int i = 0; i < kGregoryTrianglePoints; ++i) {
            EXPECT_NEAR(at[i].v, beside[i].v, 1e-4) << i;
            EXPECT_NEAR(at[i].uu, beside[i].uu, 1e-3) << i;
            EXPECT_NEAR(at[i].uv, beside[i].uv, 1e-3) << i;
            EXPECT_NEAR(at[i].vv, beside[i].vv, 1e-3) << i;
        }
    }
}

// OpenSubdiv's own weights are right where only positions are asked for.
TEST(GregoryBases, GiveOpenSubdivsPositions) {
    for (const Family& family : {Family{"poles", poles(5)}, Family{"icosahedron", icosahedron(), Scheme::loop}}) {
        SCOPED_TRACE(family.name);
        const FarTables tables = makeFarTables(family.cage, {family.scheme, 0});
        const int type = tables.patches->GetPatchArrayDescriptor(0).GetType();
        const bool isQuad = type == Far::PatchDescriptor::GREGORY_BASIS;
        ASSERT_TRUE(isQuad || type == Far::PatchDescriptor::GREGORY_TRIANGLE);
        Far::PatchTable::PatchHandle handle;
        handle.arrayIndex = handle.patchIndex = handle.vertIndex = 0;
        std::mt19937 random(3);
        std::uniform_real_distribution<double> unit(0, 0.5);
        for (int i = 0; i < 50; ++i) {
            const double u = unit(random), v = unit(random);
            double expected[kMostPatchPoints]{};
            tables.patches->EvaluateBasis(handle, u, v, expected);
            const auto weights = isQuad ? gregoryQuadWeights(u, v) : gregoryTriangleWeights(u, v);
            for (int k = 0; k < kMostPatchPoints; ++k) EXPECT_NEAR(weights[k].f, expected[k], 1e-14);
        }
    }
}

} // namespace
} // namespace relief
